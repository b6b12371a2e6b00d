// Zero padding of a square HWC image.
#pragma once

namespace tumblesight::gnc {

// `in`: side x side x channels; `out`: (side + 2) x (side + 2) x channels with a border of zeros.
void pad_by_one(const float* in, int side, int channels, float* out);

}  // namespace tumblesight::gnc

// LibTorch and the libraries under it on one thread.
#pragma once

namespace tumblesight::sim {

// For what the calling thread computes from now on. With rendering beside it, more of LibTorch's own threads
// only wait for each other, and OpenBLAS's, where it does the matrix products, by spinning: a quarter of the
// training's time.
void keep_to_one_thread();

}  // namespace tumblesight::sim

#include "gnc/nn/lstm.hpp"

#include "gnc/nn/activation.hpp"
#include "gnc/nn/kernels/gate_table.hpp"

namespace tumblesight::gnc {
namespace {

constexpr std::array<Fixed, kGateSegments + 1> kSigmoidTable = make_gate_table();

}  // namespace

Fixed gate_sigmoid(Fixed x) {
  constexpr int kFractionBits = kGatePositionBits;
  const std::int32_t inside = min(abs(x.raw()), kGateEnd - 1);
  const std::int32_t segment = inside >> kFractionBits;
  const std::int64_t rise = kSigmoidTable[segment + 1].raw() - kSigmoidTable[segment].raw();
  const std::int64_t position = inside & ((1 << kFractionBits) - 1);
  const Fixed above = Fixed::from_raw(kSigmoidTable[segment].raw() +
                                      ((rise * position + (1 << (kFractionBits - 1))) >> kFractionBits));
  return select(x.raw() < 0, Fixed(1.0) - above, above);
}

Fixed gate_tanh(Fixed x) {
  const Fixed s = gate_sigmoid(x + x);
  return (s + s) - Fixed(1.0);
}

void lstm_update(const std::int32_t* gates, const std::uint8_t* shift, int hidden, std::int16_t* h,
                 Fixed* c) {
  constexpr Fixed kBound(static_cast<double>(kLstmCellBound));
  for (int i = 0; i < hidden; ++i) {
    const auto gate = [&](int which) {
      const int g = which * hidden + i;
      return to_real(gates[g], shift[g]);
    };
    const Fixed input = gate_sigmoid(gate(0));
    const Fixed forget = gate_sigmoid(gate(1));
    const Fixed cell = gate_tanh(gate(2));
    const Fixed output = gate_sigmoid(gate(3));
    const Fixed sum = Fixed::dot(forget, c[i], input, cell, Fixed(), Fixed());
    c[i] = clamp(sum, -kBound, kBound);
    to_input(output, gate_tanh(c[i]), h[i]);
  }
}

#if TUMBLESIGHT_FLOAT32
void lstm_update(float* gates, const std::uint8_t*, int hidden, float* h, float* c) {
  float* input = gates;
  float* forget = gates + hidden;
  float* cell = gates + 2 * hidden;
  float* output = gates + 3 * hidden;
  sigmoid(input, input, 2 * hidden);
  tanh(cell, cell, hidden);
  sigmoid(output, output, hidden);
  for (int i = 0; i < hidden; ++i)
    c[i] = clamp(forget[i] * c[i] + input[i] * cell[i], -kLstmCellBound, kLstmCellBound);
  tanh(c, h, hidden);
  for (int i = 0; i < hidden; ++i) h[i] = output[i] * h[i];
}
#endif

}  // namespace tumblesight::gnc

#include "gnc/nn/lstm.hpp"

#include "gnc/nn/activation.hpp"

namespace tumblesight::gnc {
namespace {

// Table of the sigmoid at 0, 1/32, ... 16, interpolated linearly.
constexpr int kSegmentsPerUnit = 32;
constexpr int kSegments = 16 * kSegmentsPerUnit;

// e^-x for x in [0, 16] as (e^(-x / 1024))^1024; the error of the truncated series is below the last bit of a
// double. Evaluated by the compiler only.
constexpr double exp_negative(double x) {
  const double t = -x / 1024.0;
  double power = 1.0 + t * (1.0 + t / 2.0 * (1.0 + t / 3.0 * (1.0 + t / 4.0 * (1.0 + t / 5.0))));
  for (int i = 0; i < 10; ++i) power *= power;
  return power;
}

constexpr std::array<Fixed, kSegments + 1> make_sigmoid_table() {
  std::array<Fixed, kSegments + 1> table{};
  for (int i = 0; i <= kSegments; ++i)
    table[i] = Fixed(1.0 / (1.0 + exp_negative(1.0 * i / kSegmentsPerUnit)));
  return table;
}
constexpr std::array<Fixed, kSegments + 1> kSigmoidTable = make_sigmoid_table();

}  // namespace

Fixed gate_sigmoid(Fixed x) {
  constexpr int kFractionBits = Fixed::kFractionBits - 5;  // of the position within a segment
  static_assert(1 << 5 == kSegmentsPerUnit);
  constexpr std::int32_t kEnd = 16 << Fixed::kFractionBits;
  const std::int32_t inside = min(abs(x.raw()), kEnd - 1);
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

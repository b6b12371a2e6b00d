#include "gnc/nn/lstm.hpp"

#include "gnc/nn/activation.hpp"

namespace tumblesight::gnc {
namespace {

// NaN goes to the lower bound.
inline float bounded_cell(float c) {
  const float above = c > -kLstmCellBound ? c : -kLstmCellBound;
  return above < kLstmCellBound ? above : kLstmCellBound;
}

}  // namespace

void lstm_update(float* gates, int hidden, float* h, float* c) {
  float* input = gates;
  float* forget = gates + hidden;
  float* cell = gates + 2 * hidden;
  float* output = gates + 3 * hidden;
  sigmoid(input, input, 2 * hidden);
  tanh(cell, cell, hidden);
  sigmoid(output, output, hidden);
  for (int i = 0; i < hidden; ++i) c[i] = bounded_cell(forget[i] * c[i] + input[i] * cell[i]);
  tanh(c, h, hidden);
  for (int i = 0; i < hidden; ++i) h[i] = output[i] * h[i];
}

}  // namespace tumblesight::gnc

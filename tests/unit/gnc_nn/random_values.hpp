// Seeded numbers for the layer tests.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

namespace tumblesight::gnc {

class RandomValues {
 public:
  explicit RandomValues(unsigned seed) : engine_(seed) {}
  float next(float bound = 1.0F) { return bound * distribution_(engine_); }
  template <class Container>
  void fill(Container& values, float bound = 1.0F) {
    for (auto& value : values) value = next(bound);
  }
  std::vector<float> vector(std::size_t count, float bound = 1.0F) {
    std::vector<float> values(count);
    fill(values, bound);
    return values;
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<float> distribution_{-1.0F, 1.0F};
};

}  // namespace tumblesight::gnc

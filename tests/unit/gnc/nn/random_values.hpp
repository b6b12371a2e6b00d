// Seeded random values for the layer tests: floats within +-1, integers over their whole range except the
// most negative.
#pragma once

#include <cstddef>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

namespace tumblesight::gnc {

class RandomValues {
 public:
  explicit RandomValues(unsigned seed) : engine_(seed) {}
  template <class Number = float>
  Number next() {
    if constexpr (std::is_floating_point_v<Number>) {
      return std::uniform_real_distribution<Number>(-1, 1)(engine_);
    } else {
      constexpr bool kSigned = std::is_signed_v<Number>;
      constexpr int kLargest = std::numeric_limits<Number>::max();
      return static_cast<Number>(
          std::uniform_int_distribution<int>(kSigned ? -kLargest : 0, kLargest)(engine_));
    }
  }
  template <class Container>
  void fill(Container& values) {
    for (auto& value : values) value = next<std::decay_t<decltype(value)>>();
  }
  template <class Number = float>
  std::vector<Number> vector(std::size_t count) {
    std::vector<Number> values(count);
    fill(values);
    return values;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace tumblesight::gnc

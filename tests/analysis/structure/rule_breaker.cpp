// A library that breaks every rule of the flight side, to test the check of symbols.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

extern "C" int dds_write(int, const void*);
extern "C" int something_from_elsewhere(int);

namespace tumblesight::structure {

struct Base {
  virtual ~Base();
};
Base::~Base() = default;

volatile float input = 1.0F;
std::string text;

void* break_the_rules(int size) {
  std::printf("%d %f\n", size, static_cast<double>(std::exp(input) + std::tanh(input)));
  if (size < 0) throw size;
  text.reserve(static_cast<std::size_t>(size));
  void* block = std::malloc(static_cast<std::size_t>(size));
  std::free(block);
  if (std::fopen("", "r") == nullptr) std::printf("none\n");
  (void)dds_write(something_from_elsewhere(size), block);
  return new int[static_cast<std::size_t>(size)];
}

}  // namespace tumblesight::structure

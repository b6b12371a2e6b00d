#include "tests/fuzz/model_image.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  static fuzz::ModelImageTarget<gnc::Float32> target;
  target.run(fuzz::Input(data, size));
  return 0;
}

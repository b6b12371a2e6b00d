// The figures of shipped models, the .json files in fsw/models: any JSON is read, or refused with a message.
#include <stdexcept>

#include "sim/experiment/shipped_figures.hpp"
#include "tests/fuzz/fuzz.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  try {
    for (const sim::ShippedFigures& figures :
         sim::read_shipped_figures(fuzz::Input(data, size).text(), "some.json")) {
      (void)sim::worse_than(figures.rcnn, figures.cnn);
      fuzz::require(!sim::to_string(figures.condition).empty(), "a condition that was accepted has a name");
    }
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    fuzz::require(message.find("some.json") != std::string::npos, "a refusal names the file");
  }
  return 0;
}

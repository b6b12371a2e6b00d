// Records of shipped models: any JSON is read, or refused with a message.
#include <stdexcept>

#include "sim/evaluation/record.hpp"
#include "tests/fuzz/fuzz.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  try {
    for (const sim::Record& record : sim::read_records(fuzz::Input(data, size).text(), "some.json")) {
      (void)sim::worse_than(record.rcnn, record.cnn);
      fuzz::require(!sim::to_string(record.condition).empty(), "a condition that was accepted has a name");
    }
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    fuzz::require(message.find("some.json") != std::string::npos, "a refusal names the file");
  }
  return 0;
}

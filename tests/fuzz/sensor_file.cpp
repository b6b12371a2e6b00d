// Descriptions of sensors of any text: read and written again as they are, or refused with the file's name.
#include <stdexcept>
#include <string>

#include "sim/world/sensor/sensor_description.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {
namespace {

constexpr std::size_t kMostOfAMessage = 2000;

void check(const std::string& text) {
  const sim::SensorDescription sensor = sim::sensor_from_json(text, "any.json");
  require(sensor.period_s >= 0.1 && sensor.period_s <= 60.0, "the period is within its limits");
  require(sensor.settings.nearest_m < sensor.settings.farthest_m, "the gate is open");
  const sim::SensorDescription again = sim::sensor_from_json(sim::to_json(sensor), "again.json");
  require(sim::crc32_of(again) == sim::crc32_of(sensor), "what is written is read again");
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight::fuzz;
  try {
    check(Input(data, size).text());
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    require(message.find("sensor description any.json: ") == 0, "a refusal names the file");
    require(message.size() < kMostOfAMessage, "a refusal is short");
  }
  return 0;
}

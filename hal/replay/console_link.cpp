#include "hal/replay/console_link.hpp"

#include "hal/board.hpp"
#include "hal/messages/message_digest.hpp"
#include "hal/replay/text_line.hpp"

namespace tumblesight::hal::replay {
namespace {

// Q30 to millionths.
std::int64_t millionths(std::int32_t q30) {
  return (std::int64_t{q30} * 1'000'000 + (1 << 29)) >> 30;
}
// Microradians to hundredths of a degree.
std::int64_t hundredths_of_degree(std::uint32_t urad) {
  return (std::int64_t{urad} * 5'729'578 + 500'000'000) / 1'000'000'000;
}

}  // namespace

void ConsoleLink::publish(const AttitudeReport& report) {
  report_ = report;
  add_to_digest(crc_, report);
}

void ConsoleLink::publish(const Telemetry& telemetry) {
  const bool refused = report_.validity == Validity::kFrameRefused;
  TextLine line;
  line.number(refused ? announced_ : report_.sequence_number, 6).number(report_.frames_since_reset, 5);
  for (const std::int32_t part : report_.q_lrf_trf) line.decimal(millionths(part), 6, 11);
  line.decimal(hundredths_of_degree(report_.predicted_error_urad), 2, 9);
  line.decimal(telemetry.inference_us, 3, 12);
  line.text(report_.validity == Validity::kValid ? "\n" : refused ? "  refused\n" : "  not valid\n");
  board::write(line.c_str());
}

void ConsoleLink::publish(const Event& event) {
  TextLine line;
  line.text("        event ").number(static_cast<std::int64_t>(event.id));
  for (const std::int32_t argument : event.arguments) line.text(" ").number(argument);
  board::write(line.text("\n").c_str());
  add_to_digest(crc_, event);
}

}  // namespace tumblesight::hal::replay

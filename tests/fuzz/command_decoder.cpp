// Telecommands of any content, given to the application: arbitrary bytes, and packets with valid headers,
// checksums and authentication codes, so that their functions are reached. Each is counted once, as accepted
// or refused.
#include <algorithm>
#include <memory>
#include <vector>

#include "fsw/app/attitude_init_app.hpp"
#include "hal/fake/fake_model_store.hpp"
#include "hal/fake/fake_platform.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/support/app_memory.hpp"
#include "tests/support/make_packet.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::fuzz {
namespace {

using App = fsw::AttitudeInitApp;

struct Flown {
  hal::fake::FakeStopwatch stopwatch;
  hal::fake::FakeModelStore store;
  std::unique_ptr<App> booted = std::make_unique<App>();
  std::unique_ptr<App> app = std::make_unique<App>();
  std::unique_ptr<fsw::StepInputs> inputs = std::make_unique<fsw::StepInputs>();
  std::unique_ptr<fsw::StepOutputs> outputs = std::make_unique<fsw::StepOutputs>();

  Flown() {
    store.fill(gnc::lasting_model_image<gnc::FixedPoint>(7));
    booted->init({&stopwatch, &store, &fsw::kTestKeys, nullptr, hal::ResetCause::kPowerOn}, nullptr);
  }
};

std::vector<std::uint8_t> bytes_of(Input& input, std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  for (std::uint8_t& byte : bytes) byte = input.u8();
  return bytes;
}

hal::CommandPacket next_packet(Input& input, std::uint32_t& counter) {
  const std::uint8_t kind = input.u8();
  std::vector<std::uint8_t> packet;
  if (kind % 4 == 0) {
    packet = bytes_of(input, std::min<std::size_t>(input.u8(), input.left()));
    return fsw::unsigned_packet(packet);
  }
  const std::uint8_t function = input.u8();
  packet = fsw::packet_of(function, bytes_of(input, input.u8() % 64U));
  if (kind % 4 == 1) {  // one arbitrary byte, with a matching checksum
    packet[input.u8() % packet.size()] = input.u8();
    fsw::set_checksum(packet);
  }
  if (kind % 4 == 2) packet[input.u8() % packet.size()] = input.u8();
  hal::CommandPacket signed_packet =
      fsw::signed_with(fsw::kTestKey, kind & 0x10U ? input.u32() : ++counter, packet);
  if ((kind & 0x20U) != 0) signed_packet.size = input.u16();
  return signed_packet;
}

void check(const fsw::StepOutputs& outputs, std::uint32_t sent, std::uint32_t told) {
  const hal::Telemetry& h = outputs.telemetry;
  require(h.commands_accepted + h.commands_refused == sent, "every command is accepted or refused");
  std::uint32_t by_reason = 0;
  for (const std::uint32_t count : h.commands_refused_by) by_reason += count;
  require(by_reason == h.commands_refused, "every refusal has its reason");
  require(h.events == told + h.events_waiting + h.events_suppressed + h.events_lost,
          "every event is accounted for");
  require(h.mode >= hal::Mode::kStandby && h.mode <= hal::Mode::kSafe, "the mode is valid");
  require(!outputs.has_dump || outputs.dump.size <= hal::MemoryDump::kMaxBytes,
          "a dump is within its maximum size");
}

}  // namespace
}  // namespace tumblesight::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  static fuzz::Flown flown;
  constexpr int kMostSteps = 16;
  *flown.app = *flown.booted;
  fuzz::Input input(data, size);
  std::uint32_t counter = 0, sent = 0, told = 0;
  bool resets = false;
  for (int step = 0; step < kMostSteps && !input.empty() && !resets; ++step) {
    flown.inputs->command_count = 1;
    hal::CommandPacket& packet = flown.inputs->commands[0];
    packet = fuzz::next_packet(input, counter);
    resets = packet.bytes[6] ==
             static_cast<std::uint8_t>(fsw::FunctionCode::kResetCounters);  // the counts start again
    // Without scrubbing, which is slow and not under test here.
    fsw::AppMemory::step_unprotected(*flown.app, 1'000'000'000 + std::int64_t{step} * 2'700'000'000,
                                     *flown.inputs, *flown.outputs);
    ++sent;
    told += static_cast<std::uint32_t>(flown.outputs->event_count);
    if (!resets) fuzz::check(*flown.outputs, sent, told);
  }
  return 0;
}

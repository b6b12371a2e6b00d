// Samples of a run out of a recording with any content: each becomes part of a step, or is refused, and every
// step can be shown. The first byte of a sample chooses its topic, the next two have its size.
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <vector>

#include "sim/console/step_log.hpp"
#include "sim/recording/cdr_sample.hpp"
#include "sim/recording/each_topic.hpp"
#include "sim/recording/foxglove_messages.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {
namespace {

template <class Sample>
void add(const std::uint8_t* bytes, std::size_t size, sim::StepLog& log) {
  const auto sample = std::make_unique<Sample>();
  if (!sim::read_cdr(bytes, size, *sample)) return;
  require(sim::cdr_of(*sample).size() >= 4, "what was read can be written");
  if constexpr (!std::is_same_v<Sample, hal::dds::LidarFrameSample> &&
                !std::is_same_v<Sample, hal::dds::NavigationSample> &&
                !std::is_same_v<Sample, hal::dds::MemoryDumpSample>)
    log.add(*sample);
}

void show(const sim::StepLog& log) {
  const std::uint64_t steps = log.state().steps;
  constexpr auto kReplace = nlohmann::json::error_handler_t::replace;
  require(!log.rows(0).dump(-1, ' ', false, kReplace).empty(), "rows are text");
  for (std::uint64_t i = 0; i < steps; ++i) {
    require(!log.step(i).is_null(), "each step has a detail");
    require(!log.step(i).dump(-1, ' ', false, kReplace).empty(), "a detail is text");
    const sim::LoggedStep step = *log.logged(i);
    sim::ShownStep shown;
    shown.events = log.events_of(i);
    if (step.attitude) shown.report = &*step.attitude;
    for (const sim::View view : sim::kViews)
      for (const std::string& message : sim::messages_of(shown, {}, view))
        require(!message.empty(), "what is shown is text");
  }
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  sim::StepLog log;
  fuzz::Input input(data, size);
  while (!input.empty()) {
    const unsigned chosen = input.u8();
    const std::size_t sample_size = std::min<std::size_t>(input.u16(), input.left());
    const std::vector<std::uint8_t> bytes(input.rest(), input.rest() + sample_size);
    unsigned topic = 0;
    sim::each_topic([&](auto type, const char*) {
      if (topic++ == chosen % 11) fuzz::add<typename decltype(type)::type>(bytes.data(), bytes.size(), log);
    });
    for (std::size_t i = 0; i < sample_size; ++i) (void)input.u8();
  }
  log.end();
  fuzz::show(log);
  return 0;
}

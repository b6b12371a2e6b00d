#include "sim/sil/run_recorder.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <utility>

#include "sim/recording/cdr_sample.hpp"
#include "sim/recording/each_topic.hpp"
#include "sim/recording/run_step.hpp"
#include "sim/sil/failure.hpp"

namespace tumblesight::sim {
namespace {

constexpr auto kLongestWait = std::chrono::seconds(1);
constexpr auto kBetweenLooks = std::chrono::milliseconds(1);
constexpr std::size_t kTruthsKept = 16;  // a free-running flight program answers a few cycles later

void check(dds_return_t result) {
  if (result < 0)
    throw SilFailure(std::string("the recording could not join the bus: ") +
                     hal::dds::text_of_failure(result));
}

template <class Sample>
constexpr bool kIsAnswer =
    std::is_same_v<Sample, hal::dds::AttitudeSample> || std::is_same_v<Sample, hal::dds::TelemetrySample> ||
    std::is_same_v<Sample, hal::dds::EventSample> || std::is_same_v<Sample, hal::dds::MemoryDumpSample> ||
    std::is_same_v<Sample, hal::dds::StepDoneSample>;

}  // namespace

RunRecorder::RunRecorder(const hal::dds::Domain& domain, const std::string& path, double swath_m)
    : swath_m_(swath_m), file_(path) {
  // Endpoints do not receive samples of their own participant, so the recording has one of its own.
  participant_ = domain.join();
  check(participant_);
  each_topic([&](auto type, const char*) {
    using Sample = typename decltype(type)::type;
    const hal::dds::Topic& topic = hal::dds::topic_of<Sample>();
    const dds_entity_t reader = hal::dds::create_reader(domain, participant_, topic);
    check(reader);
    sources_.push_back({reader, &topic, kIsAnswer<Sample>});
  });
}

RunRecorder::~RunRecorder() {
  try {
    close();                             // of a run that failed: what explains it may have come last
  } catch (const std::runtime_error&) {  // the failure of the run is the one to report
  }
  if (participant_ > 0) dds_delete(participant_);
}

bool RunRecorder::has_writers() const {
  for (const Source& source : sources_)
    if (dds_get_matched_publications(source.reader, nullptr, 0) < 1) return false;
  return true;
}

void RunRecorder::add(const FrameTruth& truth, std::int64_t exposure_time_ns) {
  truths_.push_back({exposure_time_ns, truth});
  while (truths_.size() > kTruthsKept) truths_.pop_front();
}

void RunRecorder::add(const std::vector<const gnc::RangeImage*>& frames, std::int64_t time_ns) {
  ShownStep step;
  step.time_ns = time_ns;
  step.frames = frames;
  time_.begin_with(time_ns);
  file_.write(step, time_);
  take_samples(time_ns);
}

void RunRecorder::add(const StepAnswer& answer) {
  answered_samples_ += answer.samples;
  ShownStep step;
  step.time_ns = answer.attitude.time_ns;
  step.report = &answer.attitude;
  step.truth = truth_of(answer.attitude);
  step.swath_m = swath_m_;
  step.events = answer.events;
  time_.begin_with(step.time_ns);
  file_.write(step, time_);
  take_samples(step.time_ns);
}

// Only a report with an attitude names its frame.
const FrameTruth* RunRecorder::truth_of(const hal::AttitudeReport& report) const {
  if (!gives_attitude(report)) return nullptr;
  const auto found = std::find_if(truths_.rbegin(), truths_.rend(), [&report](const TruthOfFrame& of) {
    return of.exposure_time_ns == report.exposure_time_ns;
  });
  return found == truths_.rend() ? nullptr : &found->truth;
}

void RunRecorder::take_samples(std::int64_t time_ns) {
  last_ns_ = time_ns;
  std::vector<std::uint8_t> bytes;
  for (const Source& source : sources_) {
    while (take_cdr(source.reader, bytes)) {
      file_.write(*source.topic, time_(time_ns), bytes);
      taken_answer_samples_ += source.is_answer ? 1 : 0;
    }
  }
}

void RunRecorder::close() {
  if (std::exchange(is_closed_, true)) return;
  const auto give_up = std::chrono::steady_clock::now() + kLongestWait;
  if (last_ns_) take_samples(*last_ns_);
  while (taken_answer_samples_ < answered_samples_ && std::chrono::steady_clock::now() < give_up) {
    std::this_thread::sleep_for(kBetweenLooks);
    take_samples(last_ns_.value_or(0));
  }
  file_.close();
}

}  // namespace tumblesight::sim

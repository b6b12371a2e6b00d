#include "sim/sil/answer_collector.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "hal/dds/idl/sample_fields.hpp"
#include "sim/sil/failure.hpp"

namespace tumblesight::sim {
namespace {

hal::AttitudeReport from_sample(const hal::dds::AttitudeSample& sample) {
  hal::AttitudeReport report;
  hal::dds::copy_attitude_fields(sample, report);
  return report;
}

hal::Telemetry from_sample(const hal::dds::TelemetrySample& sample) {
  hal::Telemetry telemetry;
  hal::dds::copy_telemetry_fields(sample, telemetry);
  return telemetry;
}

hal::Event from_sample(const hal::dds::EventSample& sample) {
  hal::Event event;
  hal::dds::copy_event_fields(sample, event);
  return event;
}

std::vector<std::uint8_t> from_sample(const hal::dds::MemoryDumpSample& sample) {
  const std::size_t size = std::min<std::size_t>(sample.size, std::size(sample.bytes));
  return {sample.bytes, sample.bytes + size};
}

}  // namespace

bool AnswerCollector::Partial::complete() const {
  return done && attitudes >= done->attitudes && telemetries >= done->telemetries &&
         answer.events.size() >= done->events && dumps >= done->dumps;
}

bool AnswerCollector::Partial::has_too_many() const {
  return attitudes > done->attitudes || telemetries > done->telemetries ||
         answer.events.size() > done->events || dumps > done->dumps || dones > 1;
}

template <class Sample>
AnswerCollector::Partial& AnswerCollector::partial_of(const Sample& sample) {
  if (sample.run_id != run_id_) {
    throw SilFailure(std::string("a sample of another run on ") + hal::dds::topic_of<Sample>().name +
                     ": run id " + std::to_string(sample.run_id));
  }
  Partial& partial = partials_[sample.k];
  partial.answer.k = sample.k;
  return partial;
}

void AnswerCollector::collect() {
  hal::dds::AttitudeSample attitude;
  while (endpoints_.attitudes.take(attitude)) {
    Partial& partial = partial_of(attitude);
    partial.answer.attitude = from_sample(attitude);
    ++partial.attitudes;
  }
  hal::dds::TelemetrySample telemetry;
  while (endpoints_.telemetries.take(telemetry)) {
    Partial& partial = partial_of(telemetry);
    partial.answer.telemetry = from_sample(telemetry);
    ++partial.telemetries;
  }
  hal::dds::EventSample event;
  while (endpoints_.events.take(event)) {
    partial_of(event).answer.events.push_back(from_sample(event));
  }
  hal::dds::MemoryDumpSample dump;
  while (endpoints_.dumps.take(dump)) {
    Partial& partial = partial_of(dump);
    partial.answer.dump = from_sample(dump);
    ++partial.dumps;
  }
  hal::dds::StepDoneSample done;
  while (endpoints_.steps_done.take(done)) {
    Partial& partial = partial_of(done);
    partial.answer.state_crc32 = done.state_crc32;
    partial.done = done;
    ++partial.dones;
  }
}

std::optional<StepAnswer> AnswerCollector::next() {
  const auto found = std::find_if(partials_.begin(), partials_.end(),
                                  [](const auto& entry) { return entry.second.complete(); });
  if (found == partials_.end()) return std::nullopt;
  if (found->second.has_too_many())
    throw SilFailure("more samples than announced for step " + std::to_string(found->first));
  Partial& partial = found->second;
  partial.answer.samples = partial.attitudes + partial.telemetries +
                           static_cast<std::uint32_t>(partial.answer.events.size()) + partial.dumps +
                           partial.dones;
  StepAnswer answer = std::move(partial.answer);
  partials_.erase(found);
  return answer;
}

}  // namespace tumblesight::sim

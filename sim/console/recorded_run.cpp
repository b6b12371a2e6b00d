#include "sim/console/recorded_run.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <tuple>

#include "sim/recording/step_samples.hpp"

namespace tumblesight::sim {
namespace {

template <class Sample>
void add_to_log(const RunFile& file, const McapReader::Entry& entry, StepLog& log) {
  Sample sample;
  file.read(entry, sample);
  log.add(sample);
}

}  // namespace

RecordedRun::RecordedRun(const std::string& path) : file_(path) {
  if (file_.reader().entries(file_.channel<hal::dds::StepDoneSample>().id).empty()) log_.expect_no_answers();
  for (const Place& place : places_in_order()) place.add(file_, *place.entry, log_);
  log_.end();
  char run[32];
  std::snprintf(run, sizeof run, ", run %08x, ", log_.state().run_id);
  title_ = log_.target() + run + path.substr(path.find_last_of('/') + 1);
}

template <class Sample>
void RecordedRun::list(std::vector<Place>& places) const {
  for (const Entry& entry : file_.reader().entries(file_.channel<Sample>().id))
    places.push_back({&entry, &add_to_log<Sample>});
}

// As they came. The log combines what belongs to a step, if it is not far apart.
std::vector<RecordedRun::Place> RecordedRun::places_in_order() const {
  std::vector<Place> places;
  list<hal::dds::HelloSample>(places);
  list<hal::dds::TruthSample>(places);
  list<hal::dds::StepSample>(places);
  list<hal::dds::CommandSample>(places);
  list<hal::dds::AttitudeSample>(places);
  list<hal::dds::TelemetrySample>(places);
  list<hal::dds::EventSample>(places);
  list<hal::dds::StepDoneSample>(places);
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::tie(a.entry->chunk, a.entry->offset) < std::tie(b.entry->chunk, b.entry->offset);
  });
  return places;
}

std::string RecordedRun::ask(const std::string&) const {
  throw std::runtime_error("a recording takes no requests: start a run, and the console without a file");
}

// The recording has the time of the step at each of its messages, from 0 on (RunRecorder).
bool RecordedRun::frame(std::uint64_t step, gnc::RangeImage& frame) const {
  const std::int64_t step_ns = log_.time_ns_of(step);
  if (step_ns < 0 && log_.k_of(step) < 0) return false;
  const auto time_ns = static_cast<std::uint64_t>(step_ns - std::min<std::int64_t>(0, log_.time_ns_of(0)));
  const std::vector<Entry>& entries = file_.reader().entries(file_.channel<hal::dds::LidarFrameSample>().id);
  const auto after =
      std::upper_bound(entries.begin(), entries.end(), time_ns,
                       [](std::uint64_t time, const Entry& entry) { return time < entry.time_ns; });
  if (after == entries.begin() || std::prev(after)->time_ns != time_ns) return false;
  const auto sample = std::make_unique<hal::dds::LidarFrameSample>();
  file_.read(*std::prev(after), *sample);
  if (sample->rays == 0 || sample->rays > gnc::RangeImage::kMaxRays) return false;
  frame = frame_of(*sample);
  return true;
}

}  // namespace tumblesight::sim

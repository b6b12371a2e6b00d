#include "sim/console/joined_recording.hpp"

#include <utility>

namespace tumblesight::sim {
namespace {

constexpr std::size_t kMostWaiting = 256;  // samples
constexpr std::size_t kTimesKept = 64;     // steps

}  // namespace

// The file is one more viewer, of everything.
JoinedRecording::JoinedRecording(const std::string& path, const RunSource& run) : file_(path), shown_(run) {
  shown_.begin();
  for (const View view : kViews) shown_.follow(static_cast<std::uint32_t>(view), view);
}

void JoinedRecording::add_step(std::uint32_t k, std::int64_t time_ns) {
  time_.begin_with(time_ns);
  last_ns_ = time_(time_ns);
  time_of_step_[k] = last_ns_;
  while (time_of_step_.size() > kTimesKept) time_of_step_.erase(time_of_step_.begin());
  write_waiting(kMostWaiting);
}

void JoinedRecording::add(const hal::dds::Topic& topic, const std::vector<std::uint8_t>& bytes,
                          std::optional<std::uint32_t> k) {
  if (!k) return file_.write(topic, last_ns_, bytes);
  waiting_.push_back({&topic, *k, bytes});
  write_waiting(kMostWaiting);
}

// Those whose step has a time, and the oldest if there are more than `most`.
void JoinedRecording::write_waiting(std::size_t most) {
  const std::size_t excess = waiting_.size() > most ? waiting_.size() - most : 0;
  std::vector<Waiting> left;
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    const auto time = time_of_step_.find(waiting_[i].k);
    if (time == time_of_step_.end() && i >= excess) {
      left.push_back(std::move(waiting_[i]));
      continue;
    }
    file_.write(*waiting_[i].topic, time == time_of_step_.end() ? last_ns_ : time->second, waiting_[i].bytes);
  }
  waiting_ = std::move(left);
}

void JoinedRecording::poll() {
  for (const ShownRun::Message& message : shown_.poll())
    if (!message.is_failure)
      file_.write(View{static_cast<std::uint8_t>(message.id)}, message.time_ns, message.text);
  file_.write_due();
}

void JoinedRecording::close() {
  poll();
  write_waiting(0);
  file_.close();
}

}  // namespace tumblesight::sim

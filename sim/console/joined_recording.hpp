// JoinedRecording: a run as an MCAP file, written by a console that has joined its bus. It has what it has
// seen: a recording that is to be replayed is made by the run itself (simulate --mcap).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/console/shown_run.hpp"
#include "sim/recording/run_writer.hpp"

namespace tumblesight::sim {

class JoinedRecording {
 public:
  // `run`: that is recorded; it must outlive the object. Throws std::runtime_error, as all functions do, if
  // the file cannot be written.
  JoinedRecording(const std::string& path, const RunSource& run);

  // The time of a step, which its samples get.
  void add_step(std::uint32_t k, std::int64_t time_ns);
  // A sample as it came. `k`: its step; without one: a hello.
  void add(const hal::dds::Topic& topic, const std::vector<std::uint8_t>& bytes,
           std::optional<std::uint32_t> k);
  // What viewers show of the steps since the last call, and what is due.
  void poll();
  // What is left, and the end of the file.
  void close();

 private:
  struct Waiting {
    const hal::dds::Topic* topic;
    std::uint32_t k;
    std::vector<std::uint8_t> bytes;
  };
  void write_waiting(std::size_t most);

  RunWriter file_;
  ShownRun shown_;
  ShownTime time_;
  std::map<std::uint32_t, std::int64_t> time_of_step_;
  std::vector<Waiting> waiting_;  // for the time of their step
  std::int64_t last_ns_ = 0;
};

}  // namespace tumblesight::sim

// RunRecorder: a run as an MCAP file (RunWriter). It joins the bus as one more participant and keeps every
// sample of every topic as it came. The time of a message is the mission time of its step, counted from the
// first step if that is before 0, which the format does not have.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gnc/lidar/range_image.hpp"
#include "hal/dds/idl/domain.hpp"
#include "hal/dds/idl/topics.hpp"
#include "sim/recording/run_writer.hpp"
#include "sim/sil/answer_collector.hpp"
#include "sim/world/sensor/frame_truth.hpp"

namespace tumblesight::sim {

class RunRecorder {
 public:
  // `domain`: that of this program, which must outlive the object. `swath_m`: of the truth (FrameTruth).
  // Throws std::runtime_error, as all functions do, if the file cannot be written, or SilFailure if the bus
  // cannot be joined.
  RunRecorder(const hal::dds::Domain& domain, const std::string& path, double swath_m);
  ~RunRecorder();

  // Whether every topic that this program and the flight program write has its writer.
  bool has_writers() const;
  // At the exposure of a frame that is sent next, or later.
  void add(const FrameTruth& truth, std::int64_t exposure_time_ns);
  // What a step sends, as soon as it is sent.
  void add(const std::vector<const gnc::RangeImage*>& frames, std::int64_t time_ns);
  // The answer of the flight program.
  void add(const StepAnswer& answer);
  // Writes what is due, see McapWriter::write_due().
  void write_due() { file_.write_due(); }
  // The rest of the samples, and the end of the file. Waits up to a second for samples of answers that have
  // not come here yet: the answers came to another participant.
  void close();

 private:
  struct Source {
    dds_entity_t reader;
    const hal::dds::Topic* topic;
    bool is_answer;  // of the flight program to a step
  };
  void take_samples(std::int64_t time_ns);
  const FrameTruth* truth_of(const hal::AttitudeReport& report) const;

  double swath_m_;
  dds_entity_t participant_ = 0;
  RunWriter file_;
  ShownTime time_;
  std::vector<Source> sources_;
  struct TruthOfFrame {
    std::int64_t exposure_time_ns;
    FrameTruth truth;
  };
  std::deque<TruthOfFrame> truths_;      // of the last frames
  std::optional<std::int64_t> last_ns_;  // of the last step
  std::uint64_t answered_samples_ = 0, taken_answer_samples_ = 0;
  bool is_closed_ = false;
};

}  // namespace tumblesight::sim

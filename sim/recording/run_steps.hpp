// RunSteps: sends the steps of a recorded run (RunFile) again, unchanged: frames, attitudes of the chaser and
// signed telecommands. The flight program must reach the same states.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/recording/run_file.hpp"
#include "sim/recording/step_source.hpp"
#include "sim/world/frame_renderer.hpp"

namespace tumblesight::sim {

class RunSteps final : public StepSource {
 public:
  // Throws as RunFile does, and if steps of the run are missing or it has none.
  explicit RunSteps(const std::string& path);

  std::uint32_t steps() const override { return static_cast<std::uint32_t>(steps_.size()); }
  std::int64_t time_ns(std::uint32_t k) const override { return steps_[k].sample.time_ns; }
  SourcedStep next() override;
  // The recorded ones have the numbers that added ones would get.
  bool takes_telecommands() const override { return !has_flown_; }

  std::string target() const { return target_; }
  std::uint32_t model_crc32() const { return model_crc32_; }  // of the image that flew; 0: not known
  std::uint32_t frames() const { return frames_; }
  // False: frames that no flight program has seen (write_frames_file()).
  bool has_flown() const { return has_flown_; }
  bool is_whole() const { return file_.reader().is_whole(); }
  // Of the flight program after step k; nothing: it did not answer.
  std::optional<std::uint32_t> state_crc32(std::uint32_t k) const { return steps_[k].state_crc32; }

 private:
  struct RecordedStep {
    hal::dds::StepSample sample{};
    std::optional<hal::dds::TruthSample> truth;
    std::optional<std::uint32_t> state_crc32;
    std::vector<McapReader::Entry> frames;
    std::vector<gnc::ChaserAttitude> navigations;
    std::vector<hal::CommandPacket> packets;
  };
  template <class Sample>
  RecordedStep* step_of(const Sample& sample);
  void read_run();
  void read_steps();
  void read_contents();
  void require_whole_steps() const;

  RunFile file_;
  std::string target_;
  std::uint32_t run_id_ = 0, model_crc32_ = 0, frames_ = 0;
  bool has_flown_ = false;
  std::uint32_t frames_sent_ = 0;
  std::vector<RecordedStep> steps_;
  std::uint32_t next_ = 0;
  std::unique_ptr<hal::dds::LidarFrameSample> sample_;
  std::vector<gnc::RangeImage> images_;  // of the step in use
};

}  // namespace tumblesight::sim

#include "sim/recording/frames_file.hpp"

#include <memory>
#include <type_traits>

#include "hal/dds/idl/hello.hpp"
#include "hal/dds/idl/icd_hash.hpp"
#include "sim/recording/cdr_sample.hpp"
#include "sim/recording/run_writer.hpp"
#include "sim/recording/step_samples.hpp"

namespace tumblesight::sim {
namespace {

class FramesFile {
 public:
  FramesFile(const std::string& path, double swath_m)
      : file_(path), frame_sample_(std::make_unique<hal::dds::LidarFrameSample>()), swath_m_(swath_m) {}

  void add_hello(const std::string& target, std::uint32_t run_id) {
    run_id_ = run_id;
    hal::dds::HelloSample hello{};
    hello.role = static_cast<std::uint8_t>(hal::dds::Role::kSimulator);
    hello.icd_hash = hal::dds::icd_hash();
    hello.run_id = run_id;
    hal::dds::set_target(hello, target.c_str());
    write(hello, 0);
  }

  void add(std::uint32_t k, const SourcedStep& sourced) {
    const StepOfRun of{run_id_, k};
    const StepResult& step = sourced.step;
    ShownStep shown;
    shown.time_ns = step.time_ns;
    shown.swath_m = swath_m_;
    if (step.truth_known)
      write(truth_sample(of, step.sequence, step.frame_index, step.truth, step.time_ns), step.time_ns);
    write_step(of, sourced.input, *frame_sample_, [&](const auto& sample) {
      write(sample, step.time_ns);
      // Its points follow a frame.
      if constexpr (std::is_same_v<std::decay_t<decltype(sample)>, hal::dds::LidarFrameSample>) {
        const gnc::RangeImage frame = frame_of(sample);
        shown.frames = {&frame};
        file_.write(shown, kTime);
      }
    });
    shown.frames.clear();
    if (step.truth_known) shown.truth = &step.truth;
    file_.write(shown, kTime);
  }

  void close() { file_.close(); }

 private:
  static constexpr ShownTime kTime{};

  template <class Sample>
  void write(const Sample& sample, std::int64_t time_ns) {
    file_.write(hal::dds::topic_of<Sample>(), kTime(time_ns), cdr_of(sample));
  }

  RunWriter file_;
  std::unique_ptr<hal::dds::LidarFrameSample> frame_sample_;
  double swath_m_;
  std::uint32_t run_id_ = 0;
};

}  // namespace

void write_frames_file(const std::string& path, StepSource& source, const std::string& target,
                       std::uint32_t run_id, double swath_m) {
  FramesFile file(path, swath_m);
  file.add_hello(target, run_id);
  for (std::uint32_t k = 0; k < source.steps(); ++k) {
    SourcedStep step = source.next();
    step.input.last = k + 1 == source.steps();
    file.add(k, step);
  }
  file.close();
}

}  // namespace tumblesight::sim

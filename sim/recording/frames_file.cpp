#include "sim/recording/frames_file.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include "hal/dds/idl/hello.hpp"
#include "hal/dds/idl/icd_hash.hpp"
#include "hal/dds/idl/step_content.hpp"
#include "sim/recording/cdr_sample.hpp"
#include "sim/recording/foxglove_messages.hpp"
#include "sim/recording/mcap_writer.hpp"
#include "sim/recording/run_channels.hpp"
#include "sim/recording/step_samples.hpp"

namespace tumblesight::sim {
namespace {

class FramesFile {
 public:
  FramesFile(const std::string& path, double swath_m)
      : file_(path, "tumblesight"),
        channels_(file_),
        frame_sample_(std::make_unique<hal::dds::LidarFrameSample>()),
        swath_m_(swath_m) {}

  void add_hello(const std::string& target, std::uint32_t run_id) {
    run_id_ = run_id;
    hal::dds::HelloSample hello{};
    hello.role = static_cast<std::uint8_t>(hal::dds::Role::kSimulator);
    hello.icd_hash = hal::dds::icd_hash();
    hello.run_id = run_id;
    hal::dds::set_target(hello, target.c_str());
    write(hello, 0);
  }

  void add(std::uint32_t k, bool is_last, const SourcedStep& sourced) {
    const StepOfRun of{run_id_, k};
    const StepResult& step = sourced.step;
    const std::int64_t time_ns = std::max<std::int64_t>(0, step.time_ns);
    if (step.truth_known)
      write(truth_sample(of, step.sequence, step.frame_index, step.truth, step.time_ns), time_ns);
    hal::dds::StepContent content;
    for (const gnc::RangeImage* frame : sourced.input.frames) {
      fill(*frame_sample_, of, *frame);
      write(*frame_sample_, time_ns);
      content.add(*frame_sample_);
      file_.write(channels_.points, time_ns, point_cloud_json(*frame, time_ns));
    }
    for (const gnc::ChaserAttitude& attitude : sourced.input.navigations) {
      const hal::dds::NavigationSample sample = navigation_sample(of, attitude);
      write(sample, time_ns);
      content.add(sample);
    }
    hal::dds::StepSample announced{};
    announced.run_id = run_id_;
    announced.k = k;
    announced.time_ns = step.time_ns;
    announced.last = is_last ? 1 : 0;
    content.announce_in(announced);
    write(announced, time_ns);
    hal::AttitudeReport none;
    none.validity = hal::Validity::kNoFrame;
    if (step.truth_known)
      file_.write(channels_.transforms, time_ns, transforms_json(none, &step.truth, swath_m_, time_ns));
  }

  void close() { file_.close(); }

 private:
  template <class Sample>
  void write(const Sample& sample, std::int64_t time_ns) {
    const std::vector<std::uint8_t> bytes = cdr_of(sample);
    file_.write(channels_.of_bus.at(&hal::dds::topic_of<Sample>()), time_ns, bytes.data(), bytes.size());
  }

  McapWriter file_;
  RunChannels channels_;
  std::unique_ptr<hal::dds::LidarFrameSample> frame_sample_;
  double swath_m_;
  std::uint32_t run_id_ = 0;
};

}  // namespace

void write_frames_file(const std::string& path, StepSource& source, const std::string& target,
                       std::uint32_t run_id, double swath_m) {
  FramesFile file(path, swath_m);
  file.add_hello(target, run_id);
  for (std::uint32_t k = 0; k < source.steps(); ++k) file.add(k, k + 1 == source.steps(), source.next());
  file.close();
}

}  // namespace tumblesight::sim

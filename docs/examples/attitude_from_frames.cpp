// The smallest integration: LiDAR frames in, attitudes out. `tumblesight record` writes such frames.
//   attitude_from_frames MODEL.tsm FRAMES.tslr
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "gnc/estimation/attitude_estimator.hpp"
#include "hal/posix/file_model_store.hpp"
#include "hal/replay/recording.hpp"

using namespace tumblesight;

static gnc::AttitudeEstimator<gnc::FixedPoint> estimator;  // static memory: the estimator never uses the heap
static gnc::RangeImage frame;

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: attitude_from_frames MODEL.tsm FRAMES.tslr\n"), 2;
  hal::posix::FileModelStore store(argv[1], 2'000'000);
  const hal::ModelBank image = store.bank(0);
  if (store.status() != hal::posix::FileStatus::kOk)
    return std::fprintf(stderr, "%s: %s\n", argv[1], to_string(store.status())), 1;
  const gnc::ModelStatus loaded = estimator.load(image.data, image.size, nullptr);
  if (loaded != gnc::ModelStatus::kOk) return std::fprintf(stderr, "%s: %s\n", argv[1], to_string(loaded)), 1;

  if (!std::filesystem::is_regular_file(argv[2]))
    return std::fprintf(stderr, "%s: there is no such file\n", argv[2]), 1;
  std::ifstream file(argv[2], std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  hal::replay::Recording recording;
  const auto opened = recording.open(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  if (opened != hal::replay::RecordingStatus::kOk)
    return std::fprintf(stderr, "%s: %s\n", argv[2], to_string(opened)), 1;

  for (std::int64_t last_exposure_ns = 0; recording.has_next(); last_exposure_ns = frame.exposure_time_ns) {
    recording.read_next(frame);
    // This example assumes frames 2.7 s apart and a chaser that does not turn, and starts again after a gap.
    // With step(frame, FrameInterval, estimate) the track lasts through gaps and turns:
    // gnc/estimation/frame_tracker.hpp.
    if (frame.exposure_time_ns - last_exposure_ns > 3'000'000'000) estimator.reset();
    gnc::AttitudeEstimate estimate;
    if (estimator.step(frame, estimate) != gnc::FrameStatus::kOk) continue;  // refused: nothing has changed
    std::printf("frame %3u: q_lrf_trf", frame.sequence_number);
    for (const std::int32_t part : estimate.q_lrf_trf) std::printf(" %9.6f", part / double{1 << 30});
    std::printf(", expected error %5.2f deg\n", estimate.predicted_error_urad * 180e-6 / 3.14159265);
  }
}

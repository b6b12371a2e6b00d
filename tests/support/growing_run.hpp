// GrowingRun: a run for the console to which a test adds steps.
#pragma once

#include <atomic>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "gnc/lidar/range_image.hpp"
#include "hal/dds/idl/hello.hpp"
#include "sim/console/run_source.hpp"

namespace tumblesight::sim::test {

inline constexpr std::int64_t kPeriod_ns = 2'700'000'000;
inline constexpr std::int32_t kOneQ30 = 1 << 30;

// The network's attitude is the true one, the pose is turned by 180 degrees about z. Frames have one return,
// 10 m along the boresight.
class GrowingRun final : public RunSource {
 public:
  explicit GrowingRun(std::int64_t first_ns = kPeriod_ns) : first_ns_(first_ns) { begin(7); }
  void begin(std::uint32_t run_id) {
    run_id_ = run_id;
    k_ = 0;
    hal::dds::HelloSample hello{};
    hello.role = static_cast<std::uint8_t>(hal::dds::Role::kSimulator);
    hello.run_id = run_id;
    hal::dds::set_target(hello, "near_shoemaker");
    log_.add(hello);
  }
  void add_step(std::uint8_t events = 0, float range_m = 31.0F) {
    auto truth = sample<hal::dds::TruthSample>();
    truth.time_ns = time_ns(k_);
    truth.q_lrf_trf[0] = 1.0F;
    truth.range_m = range_m;
    log_.add(truth);
    log_.add(attitude());
    log_.add(sample<hal::dds::TelemetrySample>());
    for (int i = 0; i < events; ++i) log_.add(sample<hal::dds::EventSample>());
    auto done = sample<hal::dds::StepDoneSample>();
    done.attitudes = done.telemetries = 1;
    done.events = events;
    log_.add(done);
    ++k_;
  }
  const StepLog& log() const override { return log_; }
  const char* kind() const override { return "bus"; }
  std::string title() const override { return "near_shoemaker"; }
  std::uint64_t first_frame() const override { return 0; }
  std::string ask(const std::string&) const override {
    ++asked;
    return R"({"step":0})";
  }
  mutable std::atomic<int> asked{0};  // requests that reached the run
  bool frame(std::uint64_t step, gnc::RangeImage& frame) const override {
    if (is_damaged) throw std::runtime_error("damaged");
    frame = {};
    frame.exposure_time_ns = time_ns(static_cast<std::uint32_t>(step));
    frame.rays = 1;
    frame.fov_urad = 200'000;
    frame.ranges[0] = 1280;
    return has_frames;
  }

  bool has_frames = true, is_damaged = false;

 private:
  template <class Sample>
  Sample sample() const {
    Sample sample{};
    sample.run_id = run_id_;
    sample.k = k_;
    return sample;
  }
  std::int64_t time_ns(std::uint32_t k) const { return first_ns_ + kPeriod_ns * k; }
  hal::dds::AttitudeSample attitude() const {
    auto attitude = sample<hal::dds::AttitudeSample>();
    attitude.time_ns = attitude.exposure_time_ns = time_ns(k_);
    attitude.validity = static_cast<std::uint8_t>(hal::Validity::kValid);
    attitude.q_lrf_trf[0] = kOneQ30;
    attitude.pose_q_lrf_trf[3] = kOneQ30;  // w, x, y, z
    attitude.pose_origin_lrf_um[1] = 30'500'000;
    attitude.pose_rate_lrf_urad_s[2] = 20'000;
    attitude.pose_velocity_lrf_um_s[0] = 1000;
    return attitude;
  }

  std::int64_t first_ns_;
  StepLog log_;
  std::uint32_t run_id_ = 0, k_ = 0;
};

}  // namespace tumblesight::sim::test

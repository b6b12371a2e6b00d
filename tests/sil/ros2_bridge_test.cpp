// ROS 2 nodes beside the console: the test decodes the bytes that a reader with their settings gets.
// Verifies TS-SIL-199.
#include "sim/console/ros2_bridge.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <future>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "sim/console/bus_run.hpp"
#include "sim/recording/cdr_sample.hpp"
#include "tests/sil/sil_test_support.hpp"
#include "tests/support/growing_run.hpp"

namespace tumblesight::sim {
namespace {

using namespace std::chrono_literals;

using test::GrowingRun;
using test::kPeriod_ns;

// A ROS 2 node as far as DDS goes, with the settings that docs/console.md gives for nodes on Cyclone DDS. In
// its own process it would have its domain under its own number.
class Node {
 public:
  explicit Node(int domain) {
    constexpr dds_domainid_t kInternalId = 5000;
    const std::string configuration =
        R"(<CycloneDDS><Domain><General>
           <Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces>
           <AllowMulticast>false</AllowMulticast></General>
           <Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
           <Peers><Peer address="127.0.0.1"/></Peers><ExternalDomainId>)" +
        std::to_string(domain) + "</ExternalDomainId></Discovery></Domain></CycloneDDS>";
    domain_ = dds_create_domain(kInternalId, configuration.c_str());
    participant_ = dds_create_participant(kInternalId, nullptr, nullptr);
    EXPECT_GT(participant_, 0) << dds_strretcode(participant_);
  }
  ~Node() { dds_delete(domain_); }
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  // rmw's default profile, or the one for sensor data, which is best effort with 5 samples.
  dds_entity_t subscribe(const char* topic, const dds_topic_descriptor_t& type, bool is_reliable = true) {
    dds_qos_t* const qos = dds_create_qos();
    dds_qset_reliability(qos, is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                         is_reliable ? DDS_INFINITY : 0);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, is_reliable ? 10 : 5);
    dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
    const dds_entity_t handle = dds_create_topic(participant_, &type, topic, nullptr, nullptr);
    const dds_entity_t reader = dds_create_reader(participant_, handle, qos, nullptr);
    dds_delete_qos(qos);
    EXPECT_GT(reader, 0) << dds_strretcode(reader);
    return reader;
  }

 private:
  dds_entity_t domain_, participant_ = 0;
};

// Polls until the reader has a sample; empty after 10 s.
std::vector<std::uint8_t> next_of(dds_entity_t reader, Ros2Bridge& bridge) {
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 500; ++i) {
    bridge.poll();
    EXPECT_EQ(bridge.failure(), "");
    if (take_cdr(reader, bytes)) return bytes;
    std::this_thread::sleep_for(20ms);
  }
  return {};
}

// Classic CDR, little-endian (CORBA 3.0, 15.3), behind the encapsulation header of RTPS.
class Cdr {
 public:
  explicit Cdr(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {
    EXPECT_GT(bytes_.size(), 4U);
    if (bytes_.size() <= 4) return;
    EXPECT_EQ(bytes_[0], 0);
    EXPECT_EQ(bytes_[1], 1);
    padding_ = bytes_[3] & 3U;
    bytes_.erase(bytes_.begin(), bytes_.begin() + 4);
  }
  std::uint64_t number(std::size_t size) {
    at_ = (at_ + size - 1) / size * size;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{byte(at_ + i)} << (8 * i);
    at_ += size;
    return value;
  }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  double f64() {
    const std::uint64_t bits = number(8);
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  float f32() {
    const std::uint32_t bits = u32();
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  std::string text() {
    const std::uint32_t size = u32();
    std::string text;
    for (std::uint32_t i = 0; i + 1 < size; ++i) text += static_cast<char>(number(1));
    EXPECT_EQ(number(1), 0U);
    return text;
  }
  void expect_stamp(std::int32_t seconds, std::uint32_t nanoseconds) {
    EXPECT_EQ(static_cast<std::int32_t>(u32()), seconds);
    EXPECT_EQ(u32(), nanoseconds);
    EXPECT_EQ(text(), "lrf");
  }
  void expect_numbers(const std::vector<double>& expected) {
    for (const double value : expected) EXPECT_NEAR(f64(), value, 1e-9);
  }
  void expect_end() const { EXPECT_EQ(at_ + padding_, bytes_.size()); }

 private:
  std::uint8_t byte(std::size_t at) const { return at < bytes_.size() ? bytes_[at] : 0; }

  std::vector<std::uint8_t> bytes_;
  std::size_t at_ = 0, padding_ = 0;
};

void expect_points(std::vector<std::uint8_t> bytes) {
  Cdr cdr(std::move(bytes));
  cdr.expect_stamp(2, 700'000'000);
  EXPECT_EQ(cdr.u32(), 1U);  // height
  EXPECT_EQ(cdr.u32(), 1U);  // width
  EXPECT_EQ(cdr.u32(), 4U);  // fields
  const char* const names[] = {"x", "y", "z", "range"};
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(cdr.text(), names[i]);
    EXPECT_EQ(cdr.u32(), 4 * i);   // offset
    EXPECT_EQ(cdr.number(1), 7U);  // FLOAT32
    EXPECT_EQ(cdr.u32(), 1U);      // count
  }
  EXPECT_EQ(cdr.number(1), 0U);  // little-endian
  EXPECT_EQ(cdr.u32(), 16U);     // bytes per point
  EXPECT_EQ(cdr.u32(), 16U);     // and per row
  EXPECT_EQ(cdr.u32(), 16U);     // and in all
  for (const float value : {0.0F, 10.0F, 0.0F, 10.0F}) EXPECT_FLOAT_EQ(cdr.f32(), value);
  EXPECT_EQ(cdr.number(1), 1U);  // dense
  cdr.expect_end();
}

class Ros2 : public testing::Test {
 protected:
  const int domain_ = test::spare_domain();
  std::uint32_t id() const { return static_cast<std::uint32_t>(domain_); }
};

TEST_F(Ros2, NodesOfEachProfileGetThePoints) {
  GrowingRun run(kPeriod_ns);
  run.add_step();
  Ros2Bridge bridge(run, id());
  Node node(domain_);
  for (const bool is_reliable : {true, false})
    expect_points(next_of(
        node.subscribe("rt/lidar/points", sensor_msgs_msg_dds__PointCloud2__desc, is_reliable), bridge));
}

TEST_F(Ros2, NodesGetPosesTwistAndTransforms) {
  GrowingRun run(kPeriod_ns);
  run.add_step();
  Ros2Bridge bridge(run, id());
  Node node(domain_);
  Cdr pose(next_of(node.subscribe("rt/target/pose", geometry_msgs_msg_dds__PoseStamped__desc), bridge));
  pose.expect_stamp(2, 700'000'000);
  pose.expect_numbers({0.0, 30.5, 0.0, 0.0, 0.0, 1.0, 0.0});  // position; x, y, z, w
  pose.expect_end();
  Cdr truth(next_of(node.subscribe("rt/target/pose_true", geometry_msgs_msg_dds__PoseStamped__desc), bridge));
  truth.expect_stamp(2, 700'000'000);
  truth.expect_numbers({0.0, 31.0, 0.0, 0.0, 0.0, 0.0, 1.0});
  truth.expect_end();
  Cdr twist(next_of(node.subscribe("rt/target/twist", geometry_msgs_msg_dds__TwistStamped__desc), bridge));
  twist.expect_stamp(2, 700'000'000);
  twist.expect_numbers({0.001, 0.0, 0.0, 0.0, 0.0, 0.02});  // linear, angular
  twist.expect_end();
  Cdr tf(next_of(node.subscribe("rt/tf", tf2_msgs_msg_dds__TFMessage__desc), bridge));
  ASSERT_EQ(tf.u32(), 3U);
  tf.expect_stamp(2, 700'000'000);
  EXPECT_EQ(tf.text(), "target_true");
  tf.expect_numbers({0.0, 31.0, 0.0, 0.0, 0.0, 0.0, 1.0});
  tf.expect_stamp(2, 700'000'000);
  EXPECT_EQ(tf.text(), "target_network");
  tf.expect_numbers({0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0});
  tf.expect_stamp(2, 700'000'000);
  EXPECT_EQ(tf.text(), "target_pose");
  tf.expect_numbers({0.0, 30.5, 0.0, 0.0, 0.0, 1.0, 0.0});
  tf.expect_end();
}

// As in a recording, the first step of a run that begins before 0 is at 0.
TEST_F(Ros2, StampsAreNotNegativeAndEveryRunBeginsAnew) {
  GrowingRun run(-kPeriod_ns);
  run.add_step();
  Ros2Bridge bridge(run, id());
  Node node(domain_);
  const dds_entity_t reader = node.subscribe("rt/target/pose", geometry_msgs_msg_dds__PoseStamped__desc);
  std::vector<std::uint8_t> last;
  const auto expect_next = [&](std::int32_t seconds, std::uint32_t nanoseconds) {
    // A new reader may get the newest message twice.
    std::vector<std::uint8_t> bytes = next_of(reader, bridge);
    if (bytes == last) bytes = next_of(reader, bridge);
    last = bytes;
    Cdr(bytes).expect_stamp(seconds, nanoseconds);
  };
  expect_next(0, 0);
  run.add_step();
  expect_next(2, 700'000'000);
  run.begin(8);
  run.add_step();
  run.add_step();
  expect_next(0, 0);
  expect_next(2, 700'000'000);
  run.add_step();
  expect_next(5, 400'000'000);
}

TEST_F(Ros2, OfWhatIsThereItBeginsWithTheLastStep) {
  GrowingRun run(0);
  for (int i = 0; i < 4; ++i) run.add_step();
  Ros2Bridge bridge(run, id());
  bridge.poll();
  Node node(domain_);
  const dds_entity_t reader = node.subscribe("rt/lidar/points", sensor_msgs_msg_dds__PointCloud2__desc);
  Cdr(next_of(reader, bridge)).expect_stamp(8, 100'000'000);
}

TEST_F(Ros2, ADomainThatCannotBeOpenedIsNamed) {
  GrowingRun run(0);
  const Ros2Bridge first(run, id());
  try {
    const Ros2Bridge second(run, id());  // one process has a domain once
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("ROS domain " + std::to_string(domain_)), std::string::npos)
        << error.what();
  }
}

TEST_F(Ros2, TheHighestDomainOfRos2CanBeOpened) {
  GrowingRun run(0);
  EXPECT_NO_THROW(Ros2Bridge(run, Ros2Bridge::kMostDomain));
}

// The ROS domain has the number of the run's DDS domain.
TEST_F(Ros2, NodesFollowARunInItsOwnDomainWithoutChangingIt) {
  const std::string alone = test::trace_of(test::simulate(""));
  const BusRun shown(domain_, "");
  Ros2Bridge bridge(shown, id());
  Node node(domain_);
  const dds_entity_t points = node.subscribe("rt/lidar/points", sensor_msgs_msg_dds__PointCloud2__desc);
  const dds_entity_t poses = node.subscribe("rt/target/pose_true", geometry_msgs_msg_dds__PoseStamped__desc);
  auto watched = std::async(std::launch::async, [this] {
    return test::trace_of(test::simulate("--speed 20 --domain " + std::to_string(domain_)));
  });
  const auto is_over = [&] {
    return watched.wait_for(0s) == std::future_status::ready && shown.log().state().has_ended;
  };
  std::vector<std::uint8_t> bytes;
  int frames = 0, truths = 0;
  const auto take_all = [&] {
    bridge.poll();
    while (take_cdr(points, bytes)) ++frames;
    while (take_cdr(poses, bytes)) ++truths;
  };
  for (int i = 0; i < 1000 && !is_over(); ++i) {
    take_all();
    std::this_thread::sleep_for(20ms);
  }
  for (int i = 0; i < 25; ++i) {
    take_all();
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_EQ(watched.get(), alone);
  EXPECT_EQ(shown.failure(), "");
  EXPECT_EQ(bridge.failure(), "");
  // The run does not wait for the console, which may miss the first steps.
  EXPECT_GE(frames, 10);
  EXPECT_GE(truths, 10);
}

}  // namespace
}  // namespace tumblesight::sim

// Ros2Domain and Ros2Writer: a DDS domain in which ROS 2 nodes of this machine meet, and the writers of its
// topics with the quality of service of ROS 2's default profile. Readers of the sensor-data profile match
// them as well.
#pragma once

#include <dds/dds.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "hal/dds/idl/domain.hpp"
#include "sim/console/ros2_messages.hpp"

namespace tumblesight::sim {

class Ros2Domain {
 public:
  // `id`: ROS_DOMAIN_ID. Throws std::runtime_error if DDS cannot be set up.
  explicit Ros2Domain(std::uint32_t id);
  dds_entity_t participant() const { return domain_.participant(); }

 private:
  hal::dds::Domain domain_;
};

// A writer without a type, which tells when readers have come.
class Ros2Endpoint {
 public:
  // `type_hash`: of the message's definition (REP-2016), by which `ros2 bag` and `ros2 topic info` name it.
  Ros2Endpoint(const Ros2Domain& domain, const dds_topic_descriptor_t& type, const char* type_hash,
               const char* topic);
  // Throws std::runtime_error.
  void write(const void* sample);
  // Whether there are readers since the last call that returned true that have had the time to see the
  // writer: the two find each other one after the other.
  bool has_new_readers();

 private:
  using Clock = std::chrono::steady_clock;

  std::string topic_;
  dds_entity_t entity_ = 0;
  std::uint32_t readers_seen_ = 0;  // in total
  std::optional<Clock::time_point> due_;
};

// What the DDS type of a message is.
struct Ros2Type {
  const dds_topic_descriptor_t& descriptor;
  const char* hash;
};
template <class Message>
Ros2Type ros2_type();
template <>
Ros2Type ros2_type<Ros2Points>();
template <>
Ros2Type ros2_type<Ros2Pose>();
template <>
Ros2Type ros2_type<Ros2Twist>();
template <>
Ros2Type ros2_type<Ros2Transforms>();

template <class Message>
class Ros2Writer {
 public:
  // `topic`: of ROS 2, without the slash in front.
  Ros2Writer(const Ros2Domain& domain, const char* topic)
      : endpoint_(domain, ros2_type<Message>().descriptor, ros2_type<Message>().hash, topic) {}

  // Nothing: there is no such message at this step, and none for nodes that come late.
  void publish(std::optional<Message> message) {
    newest_ = std::move(message);
    if (newest_) endpoint_.write(&newest_->sample());
  }
  // The newest message again, for nodes that have come since.
  void repeat_for_new_readers() {
    if (endpoint_.has_new_readers() && newest_) endpoint_.write(&newest_->sample());
  }

 private:
  Ros2Endpoint endpoint_;
  std::optional<Message> newest_;
};

}  // namespace tumblesight::sim

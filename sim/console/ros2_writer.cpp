#include "sim/console/ros2_writer.hpp"

#include <stdexcept>

namespace tumblesight::sim {
namespace {

constexpr int kHistory = 10;  // of ROS 2's default profile
// Not reached: all that the history holds is below the watermark.
constexpr dds_duration_t kMaxBlocking = DDS_MSECS(100);
constexpr auto kMatchingTime = std::chrono::milliseconds(500);
// The topics of ROS 2 have this in front in DDS.
constexpr const char* kTopicPrefix = "rt/";

// A process has each domain of Cyclone only once, and that of the run may have the same number. So this
// domain has a number beyond those of the protocol inside the process, and the external one on the bus.
constexpr std::uint32_t kFirstInternalId = 1000;

// ROS 2 nodes soon forget a console that was killed.
constexpr const char* kLease = "3s";

// The watermark is above the size of ten point clouds, so that a program that does not read delays nobody.
std::string elements(std::uint32_t id) {
  return "<Discovery><ExternalDomainId>" + std::to_string(id) +
         "</ExternalDomainId></Discovery>"
         "<Internal><Watermarks><WhcHigh>8MB</WhcHigh></Watermarks></Internal>";
}

void check(dds_return_t result, const std::string& what) {
  if (result < 0) throw std::runtime_error(what + ": " + dds_strretcode(result));
}

dds_qos_t* default_profile(const std::string& user_data) {
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, kMaxBlocking);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, kHistory);
  dds_qset_durability(qos, DDS_DURABILITY_VOLATILE);
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos, 1, &representation);
  dds_qset_writer_data_lifecycle(qos, false);
  dds_qset_userdata(qos, user_data.data(), user_data.size());
  return qos;
}

}  // namespace

Ros2Domain::Ros2Domain(std::uint32_t id) {
  const std::string problem = "ROS domain " + std::to_string(id) +
                              " cannot be joined on 127.0.0.1: there may be more than 33 programs in it";
  check(domain_.open(kFirstInternalId + id, "", elements(id).c_str(), kLease), problem);
}

Ros2Endpoint::Ros2Endpoint(const Ros2Domain& domain, const dds_topic_descriptor_t& type,
                           const char* type_hash, const char* topic)
    : topic_(topic) {
  const std::string problem = "ROS 2 topic /" + topic_ + " cannot be created";
  const dds_entity_t handle =
      dds_create_topic(domain.participant(), &type, (kTopicPrefix + topic_).c_str(), nullptr, nullptr);
  check(handle, problem);
  dds_qos_t* const qos = default_profile("typehash=" + std::string(type_hash) + ";");
  entity_ = dds_create_writer(domain.participant(), handle, qos, nullptr);
  dds_delete_qos(qos);
  check(entity_, problem);
}

void Ros2Endpoint::write(const void* sample) {
  check(dds_write(entity_, sample), "ROS 2 topic /" + topic_ + " cannot be written");
}

bool Ros2Endpoint::has_new_readers() {
  dds_publication_matched_status_t status{};
  if (dds_get_publication_matched_status(entity_, &status) < 0) return false;
  if (status.total_count != readers_seen_) due_ = Clock::now() + kMatchingTime;
  readers_seen_ = status.total_count;
  if (!due_ || Clock::now() < *due_) return false;
  due_.reset();
  return true;
}

// The hashes follow from ros2.idl by REP-2016: a message of another definition has another one.
template <>
Ros2Type ros2_type<Ros2Points>() {
  return {sensor_msgs_msg_dds__PointCloud2__desc,
          "RIHS01_9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5"};
}
template <>
Ros2Type ros2_type<Ros2Pose>() {
  return {geometry_msgs_msg_dds__PoseStamped__desc,
          "RIHS01_10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8"};
}
template <>
Ros2Type ros2_type<Ros2Twist>() {
  return {geometry_msgs_msg_dds__TwistStamped__desc,
          "RIHS01_5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64"};
}
template <>
Ros2Type ros2_type<Ros2Transforms>() {
  return {tf2_msgs_msg_dds__TFMessage__desc,
          "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"};
}

}  // namespace tumblesight::sim

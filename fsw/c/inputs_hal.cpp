#include "fsw/c/inputs_hal.hpp"

#include <algorithm>
#include <array>

#include "fsw/c/arguments.hpp"
#include "hal/messages/message_fields.hpp"

namespace tumblesight::fsw::c {
namespace {

// The C structures have the fields of the messages: a missing one does not compile, and one too many changes
// the size.
static_assert(sizeof(tumblesight_attitude_report) == sizeof(hal::AttitudeReport));
static_assert(sizeof(tumblesight_telemetry) == sizeof(hal::Telemetry));
static_assert(sizeof(tumblesight_event) == sizeof(hal::Event));
static_assert(sizeof(tumblesight_memory_dump) == sizeof(hal::MemoryDump));

struct FieldCopy {
  template <class Field>
  void operator()(const Field& from, Field& to) {
    to = from;
  }
  template <class Enumeration, class Number>
  void operator()(const Enumeration& from, Number& to) {
    static_assert(sizeof(Enumeration) == sizeof(Number));
    to = static_cast<Number>(from);
  }
  template <class Element, class Number, std::size_t kSize>
  void operator()(const std::array<Element, kSize>& from, Number (&to)[kSize]) {
    for (std::size_t i = 0; i < kSize; ++i) (*this)(from[i], to[i]);
  }
};

template <class Message, class Structure>
void copy(const Message& message, Structure& structure) {
  hal::MessageFields<Message>::visit(FieldCopy{}, message, structure);
}

gnc::ChaserAttitude attitude_of(const tumblesight_chaser& chaser) {
  gnc::ChaserAttitude attitude;
  attitude.time_ns = chaser.time_ns;
  std::copy_n(chaser.q_inertial_lrf, attitude.q_inertial_lrf.size(), attitude.q_inertial_lrf.begin());
  attitude.valid = chaser.is_known;
  return attitude;
}

std::uint64_t apart_ns(std::int64_t a, std::int64_t b) {
  const auto bits_a = static_cast<std::uint64_t>(a), bits_b = static_cast<std::uint64_t>(b);
  return a > b ? bits_a - bits_b : bits_b - bits_a;
}

}  // namespace

hal::LidarStatus InputsLidar::receive(gnc::RangeImage& frame) {
  if (next_ == inputs_->frame_count) return hal::LidarStatus::kNoFrame;
  const tumblesight_frame& given = inputs_->frames[next_++];
  // Processors without unaligned loads cannot read ranges at an odd address.
  if (given.ranges == nullptr || !is_aligned(given.ranges) || given.rays > gnc::RangeImage::kMaxRays)
    return hal::LidarStatus::kWrongSize;
  frame.exposure_time_ns = given.exposure_time_ns;
  frame.sequence_number = given.sequence_number;
  frame.fov_urad = given.fov_urad;
  frame.rays = given.rays;
  std::copy_n(given.ranges, std::size_t{given.rays} * given.rays, frame.ranges.begin());
  return hal::LidarStatus::kFrame;
}

// Of the attitudes that were given, the one nearest in time.
gnc::ChaserAttitude InputsNavigation::attitude_at(std::int64_t time_ns) {
  const tumblesight_chaser* nearest = &inputs_->chaser;
  for (std::size_t i = 0; i < inputs_->frame_count; ++i) {
    const tumblesight_chaser& other = inputs_->frames[i].chaser;
    if (!other.is_known) continue;
    if (!nearest->is_known || apart_ns(other.time_ns, time_ns) < apart_ns(nearest->time_ns, time_ns))
      nearest = &other;
  }
  return attitude_of(*nearest);
}

void InputsLink::begin(const tumblesight_inputs& inputs, tumblesight_outputs& outputs) {
  outputs_ = &outputs;
  outputs.event_count = 0;
  outputs.has_dump = outputs.duties_done = false;
  dropped_by_caller_ = inputs.commands_dropped;
  for (std::size_t i = 0; i < inputs.command_count; ++i) {
    const tumblesight_command& given = inputs.commands[i];
    static_cast<void>(put(given.bytes, given.size_bytes));
  }
}

bool InputsLink::receive(hal::CommandPacket& command) {
  return queue_.receive(command);
}

hal::DroppedCommands InputsLink::take_dropped() {
  hal::DroppedCommands dropped = queue_.take_dropped();
  std::uint32_t& no_room = dropped.by[static_cast<std::size_t>(hal::CommandRefusal::kNoRoom)];
  const std::uint32_t left = UINT32_MAX - no_room;
  no_room += std::min(dropped_by_caller_, left);
  return dropped;
}

void InputsLink::publish(const hal::AttitudeReport& report) {
  copy(report, outputs_->attitude);
}
void InputsLink::publish(const hal::Telemetry& telemetry) {
  queue_.follow(telemetry.key_slot, telemetry.command_counter);
  copy(telemetry, outputs_->telemetry);
}
void InputsLink::publish(const hal::Event& event) {
  if (outputs_->event_count < TUMBLESIGHT_MAX_EVENTS) copy(event, outputs_->events[outputs_->event_count++]);
}
void InputsLink::publish(const hal::MemoryDump& dump) {
  copy(dump, outputs_->dump);
  outputs_->has_dump = true;
}

hal::ModelBank CallerModelStore::bank(int index) {
  if (index < 0 || index >= hal::kModelBanks) return {};
  const tumblesight_bank& bank = settings_.bank[index];
  if (bank.image == nullptr) return {};
  if (bank.writable == nullptr)
    return {bank.image, hal::BankWriting::kReadOnly, bank.image_bytes, bank.image_bytes};
  return {bank.image, hal::BankWriting::kAtOnce, bank.image_bytes, bank.capacity_bytes};
}

hal::WriteStatus CallerModelStore::write(int index, std::uint32_t offset, const std::uint8_t* bytes,
                                         std::uint32_t count) {
  if (index < 0 || index >= hal::kModelBanks) return hal::WriteStatus::kRefused;
  const tumblesight_bank& bank = settings_.bank[index];
  return hal::write_at_once(bank.writable, bank.capacity_bytes, offset, bytes, count);
}

hal::StoreStatus CallerPersistentStore::read(int copy, hal::StoredBytes& bytes) {
  const tumblesight_store_status status = settings_.read_stored(settings_.context, copy, bytes.data());
  const bool is_known = status >= TUMBLESIGHT_STORE_OK && status <= TUMBLESIGHT_STORE_DAMAGED;
  return is_known ? static_cast<hal::StoreStatus>(status) : hal::StoreStatus::kFailed;
}

hal::StoreStatus CallerPersistentStore::write(int copy, const hal::StoredBytes& bytes) {
  const tumblesight_store_status status = settings_.write_stored(settings_.context, copy, bytes.data());
  return status == TUMBLESIGHT_STORE_OK ? hal::StoreStatus::kOk : hal::StoreStatus::kFailed;
}

}  // namespace tumblesight::fsw::c

#include "hal/packets/telemetry_encoder.hpp"

#include "gnc/numerics/crc.hpp"

namespace tumblesight::hal::packets {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::uint16_t kTelemetryWithTime = 0x0800;  // version 0, type 0, secondary header flag 1
constexpr std::uint16_t kUnsegmented = 0xC000;
constexpr std::uint16_t kCountMask = 0x3FFF;

static_assert(packet_bytes<AttitudeReport>() <= TelemetryPacket::kMaxBytes);
static_assert(packet_bytes<Telemetry>() <= TelemetryPacket::kMaxBytes);
static_assert(packet_bytes<Event>() <= TelemetryPacket::kMaxBytes);

template <std::size_t kBytes>
struct UnsignedOf;
template <>
struct UnsignedOf<1> {
  using Type = std::uint8_t;
};
template <>
struct UnsignedOf<2> {
  using Type = std::uint16_t;
};
template <>
struct UnsignedOf<4> {
  using Type = std::uint32_t;
};
template <>
struct UnsignedOf<8> {
  using Type = std::uint64_t;
};

// Appends numbers to a packet, big-endian.
class Writer {
 public:
  explicit Writer(TelemetryPacket& packet) : packet_(packet) { packet_.size = 0; }

  // An integer, an enumerator, or an array of these.
  template <class Field>
  void operator()(const Field& field) {
    if constexpr (std::is_integral_v<Field> || std::is_enum_v<Field>) {
      const auto bits = static_cast<typename UnsignedOf<sizeof(Field)>::Type>(field);
      for (std::size_t i = sizeof(Field); i-- > 0;) put(static_cast<std::uint8_t>(bits >> (8 * i)));
    } else {
      for (const auto& element : field) (*this)(element);
    }
  }

 private:
  void put(std::uint8_t byte) { packet_.bytes[packet_.size++] = byte; }

  TelemetryPacket& packet_;
};

// 4 bytes of seconds, 4 bytes of fractions.
std::uint64_t cuc_of(std::int64_t time_ns) {
  if (time_ns < 0) return 0;
  const auto seconds = static_cast<std::uint64_t>(time_ns / kSecond_ns);
  if (seconds > UINT32_MAX) return UINT64_MAX;
  const auto rest_ns = static_cast<std::uint64_t>(time_ns % kSecond_ns);
  // Below 2^32: the largest rest is 4.3 fractions away from the next second.
  const std::uint64_t fractions =
      ((rest_ns << 32) + static_cast<std::uint64_t>(kSecond_ns) / 2) / static_cast<std::uint64_t>(kSecond_ns);
  return seconds << 32 | fractions;
}

template <class Message>
void write_packet(const Message& message, std::uint16_t apid, std::uint16_t& count, TelemetryPacket& packet) {
  constexpr std::size_t kBytes = packet_bytes<Message>();
  Writer write(packet);
  write(static_cast<std::uint16_t>(kTelemetryWithTime | apid));
  write(static_cast<std::uint16_t>(kUnsegmented | count));
  write(static_cast<std::uint16_t>(kBytes - kPrimaryHeaderBytes - 1));
  write(cuc_of(message.time_ns));
  MessageFields<Message>::visit(write, message);
  write(gnc::crc16(packet.bytes.data(), packet.size));
  count = static_cast<std::uint16_t>((count + 1) & kCountMask);
}

}  // namespace

bool are_valid(const PacketApids& apids) {
  const std::array<std::uint16_t, 4> all{apids.attitude_report, apids.telemetry, apids.event,
                                         apids.memory_dump};
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] > kMaxApid) return false;
    for (std::size_t k = 0; k < i; ++k) {
      if (all[i] == all[k]) return false;
    }
  }
  return true;
}

const TelemetryPacket& TelemetryEncoder::encode(const AttitudeReport& report) {
  write_packet(report, apids_.attitude_report, counts_.attitude_report, packet_);
  return packet_;
}

const TelemetryPacket& TelemetryEncoder::encode(const Telemetry& telemetry) {
  write_packet(telemetry, apids_.telemetry, counts_.telemetry, packet_);
  return packet_;
}

const TelemetryPacket& TelemetryEncoder::encode(const Event& event) {
  write_packet(event, apids_.event, counts_.event, packet_);
  return packet_;
}

const TelemetryPacket& TelemetryEncoder::encode(const MemoryDump& dump) {
  write_packet(dump, apids_.memory_dump, counts_.memory_dump, packet_);
  return packet_;
}

}  // namespace tumblesight::hal::packets

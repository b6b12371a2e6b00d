// Writes telemetry packets, telecommand packets and what they hold, for the test of the XTCE database:
//   write_packets FOLDER
//     telemetry.bin   packets of all kinds, one after the other
//     telemetry.json  their messages, a line each
//     commands.bin    telecommand packets, one after the other
//     commands.json   their function codes and arguments, a line each
#include <fstream>
#include <limits>
#include <string>

#include "hal/packets/telemetry_encoder.hpp"
#include "tests/support/make_packet.hpp"
#include "tests/support/print_message.hpp"

namespace {

using namespace tumblesight;

// Sets all fields from `next()`, a number of 64 bits per value.
template <class Next>
struct Fill {
  Next next;

  template <class Field>
  void operator()(Field& field) {
    if constexpr (std::is_integral_v<Field> || std::is_enum_v<Field>) {
      field = static_cast<Field>(next());
    } else {
      for (auto& element : field) (*this)(element);
    }
  }
};

class Output {
 public:
  explicit Output(const std::string& folder)
      : packets_(folder + "/telemetry.bin", std::ios::binary), messages_(folder + "/telemetry.json") {}

  template <class Message>
  void put(const Message& message) {
    const hal::packets::TelemetryPacket& packet = encoder_.encode(message);
    packets_.write(reinterpret_cast<const char*>(packet.bytes.data()), packet.size);
    test::print(messages_, message);
  }

  // The default, all bits 0, all bits 1, the lowest and highest signed values, and values that all differ.
  template <class Message>
  void put_extremes() {
    put(Message{});
    std::uint64_t number = 0;
    for (const std::uint64_t bits : {std::uint64_t{0}, ~std::uint64_t{0}})
      put_filled<Message>([=] { return bits; });
    put_filled<Message>([] { return std::uint64_t{0x8000'0000'8000'8080}; });
    put_filled<Message>([] { return std::uint64_t{0x7FFF'FFFF'7FFF'7F7F}; });
    put_filled<Message>([] { return std::uint64_t{0x8000'0000'0000'0000}; });
    put_filled<Message>([] { return std::uint64_t{0x7FFF'FFFF'FFFF'FFFF}; });
    for (int i = 0; i < 20; ++i)
      put_filled<Message>([&] { return number += 0x9E37'79B9'7F4A'7C15; });  // the golden ratio times 2^64
  }

 private:
  template <class Message, class Next>
  void put_filled(Next next) {
    Message message;
    hal::MessageFields<Message>::visit(Fill<Next>{next}, message);
    put(message);
  }

  std::ofstream packets_;
  std::ofstream messages_;
  hal::packets::TelemetryEncoder encoder_;
};

void write_commands(const std::string& folder) {
  std::ofstream packets(folder + "/commands.bin", std::ios::binary);
  std::ofstream contents(folder + "/commands.json");
  std::uint32_t counter = 0x01020304;
  const auto put = [&](hal::FunctionCode function, const std::vector<std::uint8_t>& arguments) {
    const auto code = static_cast<std::uint8_t>(function);
    const hal::CommandPacket packet =
        fsw::signed_with(fsw::kTestKey, ++counter, fsw::packet_of(code, arguments));
    packets.write(reinterpret_cast<const char*>(packet.bytes.data()), packet.size);
    contents << "{\"size\": " << packet.size << ", \"function\": " << +code << ", \"counter\": " << counter
             << ", \"arguments\": ";
    test::print_value(contents, arguments);
    contents << "}\n";
  };
  put(hal::FunctionCode::kNoop, {});
  put(hal::FunctionCode::kSetMode, {3});
  std::vector<std::uint8_t> segment{0x00, 0x01, 0xFF, 0xFE, 0x00};
  put(hal::FunctionCode::kModelLoad, segment);
  for (int i = 1; i < hal::kMaxModelSegmentBytes; ++i) segment.push_back(static_cast<std::uint8_t>(i));
  put(hal::FunctionCode::kModelLoad, segment);
  put(hal::FunctionCode::kModelValidate, {0x00, 0x12, 0x34, 0x56, 0x89, 0xAB, 0xCD, 0xEF});
  put(hal::FunctionCode::kModelBegin, {2});
  put(hal::FunctionCode::kMemoryDump, {1, 0xFF, 0xFF, 0xFF, 0xFE, 0x04, 0x00});
  put(hal::FunctionCode::kTableLoad, {0, 1, 0, 20, 0xFF});
  put(hal::FunctionCode::kSetParameter, {2, 0x80, 0x00, 0x00, 0x01});
  put(hal::FunctionCode::kDisableResponse, {8});
  put(hal::FunctionCode::kKeyActivate, {1, 16, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 0xFF});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  {
    Output output(argv[1]);
    output.put_extremes<hal::AttitudeReport>();
    output.put_extremes<hal::Telemetry>();
    output.put_extremes<hal::Event>();
    output.put_extremes<hal::MemoryDump>();
  }
  write_commands(argv[1]);
  return 0;
}

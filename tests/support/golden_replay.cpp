#include "tests/support/golden_replay.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "hal/packets/telemetry_encoder.hpp"
#include "hal/replay/text_line.hpp"
#include "tests/support/read_packet.hpp"

namespace tumblesight::test {
namespace {

// Without the file, or with packets of a wrong size, the digest is another one.
std::vector<std::uint8_t> bytes_of(const std::string& file) {
  std::ifstream in(std::string(TUMBLESIGHT_SOURCE_DIR) + "/" + file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

GoldenReplay::GoldenReplay() : recorded_(bytes_of("tests/audit/near_shoemaker.tslr")) {
  static_cast<void>(recording.open(recorded_.data(), recorded_.size()));
  const std::vector<std::uint8_t> model = bytes_of("fsw/models/near_shoemaker.tsm");
  model_bytes_ = model.size();
  model_lines_.resize(model.size() / sizeof(Line) + 1);
  std::copy(model.begin(), model.end(), model_lines_[0].bytes);
}

void GoldenReplay::take(const std::uint8_t* packet, std::size_t size) {
  const hal::packets::PacketApids apids;
  const int apid = (packet[0] & 7) * 256 + packet[1];
  if (apid == apids.attitude_report) link_.publish(read_packet<hal::AttitudeReport>(packet, size));
  if (apid == apids.telemetry) telemetry_ = read_packet<hal::Telemetry>(packet, size);
  if (apid == apids.event) link_.publish(read_packet<hal::Event>(packet, size));
}

std::string GoldenReplay::digest() const {
  return hal::replay::TextLine().hexadecimal(link_.digest()).c_str();
}

std::string GoldenReplay::golden_digest() {
  std::ifstream in(std::string(TUMBLESIGHT_SOURCE_DIR) + "/tests/audit/golden.txt");
  std::string program, numerics, digest;
  in >> program >> numerics >> digest;
  return program == "flight_replay" ? digest : "tests/audit/golden.txt has another first line";
}

}  // namespace tumblesight::test

// The board of docs/examples/smallest.c, with recorded frames: it prints what flight_replay prints, and the
// same digest.
#include "hal/board.hpp"
#include "hal/messages/message_fields.hpp"
#include "hal/replay/console_link.hpp"
#include "hal/replay/recording.hpp"
#include "hal/replay/text_line.hpp"

extern "C" {
#include "docs/examples/board.h"
extern const std::uint8_t tumblesight_model_image[], tumblesight_model_image_end[];
extern const std::uint8_t tumblesight_recording[], tumblesight_recording_end[];
}

namespace {

using namespace tumblesight;

struct Board {
  Board() { static_cast<void>(recording.open(tumblesight_recording, size())); }
  static std::size_t size() {
    return static_cast<std::size_t>(tumblesight_recording_end - tumblesight_recording);
  }

  hal::replay::Recording recording;
  hal::replay::ConsoleLink link;
  gnc::RangeImage image;
  tumblesight_frame frame{};
  int kicks = 0;
};

Board& board() {
  static Board the_board;
  return the_board;
}

struct FieldCopy {
  template <class Field, class Number>
  void operator()(Field& to, const Number& from) {
    to = static_cast<Field>(from);
  }
  template <class Element, std::size_t kSize, class Number>
  void operator()(std::array<Element, kSize>& to, const Number (&from)[kSize]) {
    for (std::size_t i = 0; i < kSize; ++i) (*this)(to[i], from[i]);
  }
};

template <class Message, class Structure>
void publish(const Structure& structure) {
  Message message;
  hal::MessageFields<Message>::visit(FieldCopy{}, message, structure);
  board().link.publish(message);
}

}  // namespace

const std::uint8_t* board_model_image(std::size_t* size_bytes) {
  *size_bytes = static_cast<std::size_t>(tumblesight_model_image_end - tumblesight_model_image);
  return tumblesight_model_image;
}

bool board_wait(std::int64_t* now_ns) {
  if (board().recording.has_next()) {
    *now_ns = board().recording.next_exposure_time_ns();
    return true;
  }
  hal::board::write(
      hal::replay::TextLine().text("digest ").hexadecimal(board().link.digest()).text("\n").c_str());
  return false;
}

const tumblesight_frame* board_frames(std::size_t* count) {
  Board& b = board();
  b.link.announce(b.recording.next_sequence_number());
  b.recording.read_next(b.image);
  b.frame = {b.image.exposure_time_ns, b.image.sequence_number,
             b.image.fov_urad,         b.image.rays,
             b.image.ranges.data(),    board_chaser(b.image.exposure_time_ns)};
  *count = 1;
  return &b.frame;
}

tumblesight_chaser board_chaser(std::int64_t) {
  const gnc::ChaserAttitude& recorded = board().recording.chaser_attitude();
  tumblesight_chaser chaser{recorded.time_ns, {}, recorded.valid};
  for (std::size_t i = 0; i < 4; ++i) chaser.q_inertial_lrf[i] = recorded.q_inertial_lrf[i];
  return chaser;
}

void board_send(const tumblesight_app* app, const tumblesight_outputs* outputs) {
  publish<hal::AttitudeReport>(outputs->attitude);
  publish<hal::Telemetry>(outputs->telemetry);
  for (std::size_t i = 0; i < outputs->event_count; ++i) publish<hal::Event>(outputs->events[i]);
  board().link.digest(tumblesight_state_crc32(app));
}

void board_kick_watchdog() {
  ++board().kicks;
}

void board_log(const char* text) {
  hal::board::write(text);
  hal::board::write("\n");
}

#include "fsw/programs/fprime/AttitudeInit/AttitudeInit.hpp"

#include <Fw/Types/String.hpp>
#include <algorithm>

namespace Tumblesight {
namespace {

// Of docs/icd.md.
constexpr U8 kInformation = 0;
constexpr U8 kWarning = 1;
// That one cycle takes from its queue.
constexpr int kMostMessages = 256;

// nullptr: the buffer does not hold a frame of this size. The application counts the frame as bad.
const U16* ranges_in(const Fw::Buffer& buffer, U16 rays) {
  const U8* const data = buffer.getData();
  const bool is_aligned = reinterpret_cast<std::uintptr_t>(data) % alignof(U16) == 0;
  const bool has_size = buffer.getSize() == sizeof(U16) * rays * rays;
  return is_aligned && has_size ? reinterpret_cast<const U16*>(data) : nullptr;
}

}  // namespace

void AttitudeInit::boot(const tumblesight_settings& settings) {
  const tumblesight_status status = tumblesight_init(memory_, sizeof memory_, &settings, &app_);
  if (status != TUMBLESIGHT_OK) log_WARNING_HI_BootFailed(Fw::String(tumblesight_status_text(status)));
}

void AttitudeInit::schedIn_handler(FwIndexType, U32) {
  take_messages();
  const tumblesight_inputs inputs = inputs_now();
  const tumblesight_outputs* outputs = nullptr;
  // It only fails without an application, which boot() has reported.
  if (tumblesight_step(app_, &inputs, &outputs) == TUMBLESIGHT_OK) {
    send_packets();
    report(*outputs);
  }
  return_buffers();
}

// Frames that do not fit into one step stay in the queue, and so does what came after them. Commands do not:
// the application keeps places for others than segments of a model, and this queue does not.
void AttitudeInit::take_messages() {
  for (int i = 0; i < kMostMessages && !frames_.is_full(); ++i) {
    if (doDispatch() != MSG_DISPATCH_OK) return;
  }
}

void AttitudeInit::return_buffers() {
  for (std::size_t i = 0; i < frame_buffers_.count; ++i) frameReturnOut_out(0, frame_buffers_.elements[i]);
  frames_.count = frame_buffers_.count = 0;
}

void AttitudeInit::frameIn_handler(FwIndexType, I64 exposureTime_ns, U32 sequenceNumber, U32 fov_urad,
                                   U16 rays, Fw::Buffer& ranges) {
  frames_.add(
      {exposureTime_ns, sequenceNumber, fov_urad, rays, ranges_in(ranges, rays), chaser_at(exposureTime_ns)});
  frame_buffers_.add(ranges);
}

void AttitudeInit::frameIn_overflowHook(FwIndexType, I64, U32, U32, U16, Fw::Buffer& ranges) {
  ++frames_dropped_;
  frameReturnOut_out(0, ranges);
}

void AttitudeInit::commandIn_handler(FwIndexType, Fw::Buffer& packet) {
  // The application counts what it drops. Before the boot there is none.
  static_cast<void>(tumblesight_put_command(app_, packet.getData(), packet.getSize()));
  commandReturnOut_out(0, packet);
}

void AttitudeInit::commandIn_overflowHook(FwIndexType, Fw::Buffer& packet) {
  ++commands_dropped_;
  commandReturnOut_out(0, packet);
}

// Slips stay 0: the rate group counts and reports its own.
tumblesight_inputs AttitudeInit::inputs_now() {
  constexpr I64 kSecond_ns = 1'000'000'000;
  const Fw::Time now = getTime();
  tumblesight_inputs inputs{};
  inputs.now_ns = now.getSeconds() * kSecond_ns + I64{now.getUSeconds()} * 1000;
  inputs.frames = frames_.elements.data();
  inputs.frame_count = frames_.count;
  inputs.frames_dropped = frames_dropped_.exchange(0);
  inputs.commands_dropped = commands_dropped_.exchange(0);
  inputs.chaser = chaser_at(inputs.now_ns);
  return inputs;
}

tumblesight_chaser AttitudeInit::chaser_at(I64 time_ns) {
  tumblesight_chaser chaser{};
  if (!isConnected_chaserGet_OutputPort(0)) return chaser;
  I32(&q)[4] = chaser.q_inertial_lrf;
  chaser.is_known = chaserGet_out(0, time_ns, q[0], q[1], q[2], q[3]);
  chaser.time_ns = time_ns;
  return chaser;
}

void AttitudeInit::send_packets() {
  U8 packet[TUMBLESIGHT_MAX_PACKET_BYTES];
  while (const std::size_t size = tumblesight_take_packet(app_, packet, sizeof packet)) {
    Fw::Buffer buffer = packetAllocate_out(0, static_cast<U32>(size));
    if (buffer.getData() == nullptr || buffer.getSize() < size) {
      ++packets_lost_;
      continue;
    }
    std::copy_n(packet, size, buffer.getData());
    buffer.setSize(static_cast<U32>(size));
    packetOut_out(0, buffer);
  }
}

void AttitudeInit::report(const tumblesight_outputs& outputs) {
  tlmWrite_Mode(outputs.telemetry.mode);
  tlmWrite_Validity(outputs.attitude.validity);
  tlmWrite_FramesUsed(outputs.telemetry.frames_used);
  tlmWrite_PosesVerified(outputs.telemetry.poses_verified);
  tlmWrite_StepTime_us(outputs.telemetry.step_us);
  tlmWrite_PacketsLost(packets_lost_);
  for (std::size_t i = 0; i < outputs.event_count; ++i) report(outputs.events[i]);
  if (outputs.duties_done && isConnected_watchdogOut_OutputPort(0)) watchdogOut_out(0, 0);
}

void AttitudeInit::report(const tumblesight_event& event) {
  const I32(&a)[3] = event.arguments;
  if (event.severity == kInformation) return log_ACTIVITY_HI_Information(event.id, a[0], a[1], a[2]);
  if (event.severity == kWarning) return log_WARNING_LO_Warning(event.id, a[0], a[1], a[2]);
  log_WARNING_HI_Error(event.id, a[0], a[1], a[2]);
}

}  // namespace Tumblesight

// What F Prime generates out of AttitudeInit.fpp, written by hand: the functions that the component calls and
// overrides, with a queue for its asynchronous ports. The other components are the callbacks that a test
// sets.
#ifndef TUMBLESIGHT_ATTITUDE_INIT_COMPONENT_AC_HPP
#define TUMBLESIGHT_ATTITUDE_INIT_COMPONENT_AC_HPP

#include <Fw/Types/String.hpp>
#include <deque>
#include <functional>
#include <string>
#include <vector>

namespace Fw {

class Buffer {
 public:
  Buffer() = default;
  Buffer(U8* data, FwSizeType size) : data_(data), size_(size) {}
  U8* getData() const { return data_; }
  FwSizeType getSize() const { return size_; }
  void setSize(FwSizeType size) { size_ = size; }

 private:
  U8* data_ = nullptr;
  FwSizeType size_ = 0;
};

class Time {
 public:
  Time(U32 seconds, U32 useconds) : seconds_(seconds), useconds_(useconds) {}
  U32 getSeconds() const { return seconds_; }
  U32 getUSeconds() const { return useconds_; }

 private:
  U32 seconds_, useconds_;
};

class QueuedComponentBase {
 public:
  enum MsgDispatchStatus { MSG_DISPATCH_OK, MSG_DISPATCH_EMPTY, MSG_DISPATCH_ERROR, MSG_DISPATCH_EXIT };

 protected:
  virtual ~QueuedComponentBase() = default;
  virtual MsgDispatchStatus doDispatch() = 0;
};

}  // namespace Fw

namespace Tumblesight {

class AttitudeInitComponentBase : public Fw::QueuedComponentBase {
 public:
  struct Event {
    std::string severity;
    U16 number;
    I32 arguments[3];
  };
  // The rest of a topology.
  struct Topology {
    std::function<Fw::Buffer(FwSizeType size)> packet_allocate;
    std::function<void(Fw::Buffer&)> packet_out, frame_return, command_return;
    std::function<bool(I64&, I32&, I32&, I32&, I32&)> chaser_get;  // empty: not connected
    std::function<void(U32)> watchdog;                             // empty: not connected
    I64 time_us = 0;
    std::vector<Event> events;
    std::vector<std::string> boot_failures;
    U32 mode = 0, validity = 0, frames_used = 0, poses_verified = 0, step_time_us = 0, packets_lost = 0;
  };
  Topology topology;

  void init(FwSizeType queueDepth) { depth_ = queueDepth; }

  // The input ports.
  void schedIn(U32 context) { schedIn_handler(0, context); }
  void frameIn(I64 exposureTime_ns, U32 sequenceNumber, U32 fov_urad, U16 rays, Fw::Buffer ranges) {
    if (queue_.size() == depth_)
      return frameIn_overflowHook(0, exposureTime_ns, sequenceNumber, fov_urad, rays, ranges);
    queue_.emplace_back(
        [=]() mutable { frameIn_handler(0, exposureTime_ns, sequenceNumber, fov_urad, rays, ranges); });
  }
  void commandIn(Fw::Buffer packet) {
    if (queue_.size() == depth_) return commandIn_overflowHook(0, packet);
    queue_.emplace_back([=]() mutable { commandIn_handler(0, packet); });
  }

 protected:
  explicit AttitudeInitComponentBase(const char*) {}

  MsgDispatchStatus doDispatch() override {
    if (queue_.empty()) return MSG_DISPATCH_EMPTY;
    const auto message = queue_.front();
    queue_.pop_front();
    message();
    return MSG_DISPATCH_OK;
  }

  virtual void schedIn_handler(FwIndexType portNum, U32 context) = 0;
  virtual void frameIn_handler(FwIndexType portNum, I64 exposureTime_ns, U32 sequenceNumber, U32 fov_urad,
                               U16 rays, Fw::Buffer& ranges) = 0;
  virtual void frameIn_overflowHook(FwIndexType portNum, I64 exposureTime_ns, U32 sequenceNumber,
                                    U32 fov_urad, U16 rays, Fw::Buffer& ranges) = 0;
  virtual void commandIn_handler(FwIndexType portNum, Fw::Buffer& fwBuffer) = 0;
  virtual void commandIn_overflowHook(FwIndexType portNum, Fw::Buffer& fwBuffer) = 0;

  void frameReturnOut_out(FwIndexType, Fw::Buffer& fwBuffer) { topology.frame_return(fwBuffer); }
  void commandReturnOut_out(FwIndexType, Fw::Buffer& fwBuffer) { topology.command_return(fwBuffer); }
  Fw::Buffer packetAllocate_out(FwIndexType, FwSizeType size) { return topology.packet_allocate(size); }
  void packetOut_out(FwIndexType, Fw::Buffer& fwBuffer) { topology.packet_out(fwBuffer); }
  bool isConnected_chaserGet_OutputPort(FwIndexType) { return static_cast<bool>(topology.chaser_get); }
  bool chaserGet_out(FwIndexType, I64& time_ns, I32& qw, I32& qx, I32& qy, I32& qz) {
    return topology.chaser_get(time_ns, qw, qx, qy, qz);
  }
  bool isConnected_watchdogOut_OutputPort(FwIndexType) { return static_cast<bool>(topology.watchdog); }
  void watchdogOut_out(FwIndexType, U32 code) { topology.watchdog(code); }

  Fw::Time getTime() {
    return {static_cast<U32>(topology.time_us / 1'000'000), static_cast<U32>(topology.time_us % 1'000'000)};
  }

  void log_WARNING_HI_BootFailed(const Fw::StringBase& reason) {
    topology.boot_failures.emplace_back(reason.toChar());
  }
  void log_ACTIVITY_HI_Information(U16 number, I32 argument1, I32 argument2, I32 argument3) {
    topology.events.push_back({"ACTIVITY_HI", number, {argument1, argument2, argument3}});
  }
  void log_WARNING_LO_Warning(U16 number, I32 argument1, I32 argument2, I32 argument3) {
    topology.events.push_back({"WARNING_LO", number, {argument1, argument2, argument3}});
  }
  void log_WARNING_HI_Error(U16 number, I32 argument1, I32 argument2, I32 argument3) {
    topology.events.push_back({"WARNING_HI", number, {argument1, argument2, argument3}});
  }

  void tlmWrite_Mode(U8 value) { topology.mode = value; }
  void tlmWrite_Validity(U8 value) { topology.validity = value; }
  void tlmWrite_FramesUsed(U32 value) { topology.frames_used = value; }
  void tlmWrite_PosesVerified(U32 value) { topology.poses_verified = value; }
  void tlmWrite_StepTime_us(U32 value) { topology.step_time_us = value; }
  void tlmWrite_PacketsLost(U32 value) { topology.packets_lost = value; }

 private:
  std::deque<std::function<void()>> queue_;
  FwSizeType depth_ = 0;
};

}  // namespace Tumblesight

#endif

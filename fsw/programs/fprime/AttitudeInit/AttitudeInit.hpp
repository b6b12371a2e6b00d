// AttitudeInit: the flight application as a component of F Prime, over its C interface.
#ifndef TUMBLESIGHT_ATTITUDE_INIT_HPP
#define TUMBLESIGHT_ATTITUDE_INIT_HPP

#include <array>
#include <atomic>

#include "fsw/c/tumblesight_c.h"
#include "fsw/programs/fprime/AttitudeInit/AttitudeInitComponentAc.hpp"

namespace Tumblesight {

class AttitudeInit final : public AttitudeInitComponentBase {
 public:
  explicit AttitudeInit(const char* name) : AttitudeInitComponentBase(name) {}

  // Call it between init() and the first cycle. The model images stay where they are.
  void boot(const tumblesight_settings& settings);

 private:
  friend class AttitudeInitTester;

  void schedIn_handler(FwIndexType port, U32 context) override;
  void frameIn_handler(FwIndexType port, I64 exposureTime_ns, U32 sequenceNumber, U32 fov_urad, U16 rays,
                       Fw::Buffer& ranges) override;
  void frameIn_overflowHook(FwIndexType port, I64 exposureTime_ns, U32 sequenceNumber, U32 fov_urad, U16 rays,
                            Fw::Buffer& ranges) override;
  void commandIn_handler(FwIndexType port, Fw::Buffer& packet) override;
  void commandIn_overflowHook(FwIndexType port, Fw::Buffer& packet) override;

  void take_messages();
  void return_buffers();
  tumblesight_inputs inputs_now();
  tumblesight_chaser chaser_at(I64 time_ns);
  void report(const tumblesight_outputs& outputs);
  void report(const tumblesight_event& event);
  void send_packets();

  template <class Element, std::size_t kSize>
  struct List {
    std::array<Element, kSize> elements{};
    std::size_t count = 0;

    bool is_full() const { return count == kSize; }
    void add(const Element& element) { elements[count++] = element; }
  };

  alignas(8) U8 memory_[TUMBLESIGHT_MEMORY_BYTES] = {};
  tumblesight_app* app_ = nullptr;
  // The frames that this cycle's step gets, and the buffers that they are in.
  List<tumblesight_frame, TUMBLESIGHT_MAX_FRAMES> frames_;
  List<Fw::Buffer, TUMBLESIGHT_MAX_FRAMES> frame_buffers_;
  // For lack of room in the queue. The senders' threads count.
  std::atomic<U32> frames_dropped_{0};
  std::atomic<U32> commands_dropped_{0};
  U32 packets_lost_ = 0;
};

}  // namespace Tumblesight

#endif  // TUMBLESIGHT_ATTITUDE_INIT_HPP

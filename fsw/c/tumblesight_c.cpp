#include "fsw/c/tumblesight_c.h"

#include <algorithm>
#include <initializer_list>
#include <new>

#include "fsw/app/attitude_init_app.hpp"
#include "fsw/app/cycle.hpp"
#include "fsw/c/apids.hpp"
#include "fsw/c/arguments.hpp"
#include "fsw/c/inputs_hal.hpp"
#include "fsw/c/parameters.hpp"
#include "hal/messages/event_text.hpp"
#include "hal/packets/telemetry_encoder.hpp"

using namespace tumblesight;
using namespace tumblesight::fsw::c;

struct tumblesight_app {
  explicit tumblesight_app(const tumblesight_settings& given)
      : settings(given), encoder(fsw::c::apids_of(given.apids).telemetry) {}

  void boot();
  void step(const tumblesight_inputs& inputs);
  const hal::packets::TelemetryPacket* next_packet();

  tumblesight_settings settings;
  tumblesight_outputs outputs{};
  fsw::c::InputsLidar lidar;
  fsw::c::InputsNavigation navigation;
  fsw::c::InputsLink link;
  fsw::c::OutputsWatchdog watchdog{outputs};
  fsw::c::CallerStopwatch stopwatch{settings};
  fsw::c::CallerModelStore models{settings};
  fsw::c::CallerPersistentStore store{settings};
  hal::packets::TelemetryEncoder encoder;
  bool has_stepped = false;
  std::size_t packets_taken = 0;
  fsw::CycleWorkspace workspace;
  fsw::AttitudeInitApp app;
};

static_assert(sizeof(tumblesight_app) + alignof(tumblesight_app) <= TUMBLESIGHT_MEMORY_BYTES);
static_assert(TUMBLESIGHT_PERIOD_NS == fsw::config::kFramePeriod_ns);
static_assert(TUMBLESIGHT_MAX_RAYS == gnc::RangeImage::kMaxRays);
static_assert(TUMBLESIGHT_MAX_FRAMES == fsw::config::kMaxDeliveriesPerCycle);
static_assert(TUMBLESIGHT_MAX_COMMANDS == fsw::config::kMaxCommandsPerStep);
static_assert(TUMBLESIGHT_COMMAND_PLACES == 2 * TUMBLESIGHT_MAX_COMMANDS, "all are carried out in two steps");
static_assert(TUMBLESIGHT_MAX_COMMAND_BYTES == hal::CommandPacket::kMaxBytes);
static_assert(TUMBLESIGHT_MAX_EVENTS == fsw::config::kMaxEventsPerStep);
static_assert(TUMBLESIGHT_MAX_PACKET_BYTES == hal::packets::TelemetryPacket::kMaxBytes);
static_assert(TUMBLESIGHT_STORED_BYTES == hal::kStoredBytes);
static_assert(TUMBLESIGHT_KEY_SLOTS == hal::kCommandKeySlots);
static_assert(TUMBLESIGHT_KEY_BYTES == std::tuple_size_v<hal::CommandKey>);
static_assert(TUMBLESIGHT_RESET_OTHER == static_cast<int>(hal::ResetCause::kOther));
static_assert(TUMBLESIGHT_STORE_DAMAGED == static_cast<int>(hal::StoreStatus::kDamaged));
static_assert(TUMBLESIGHT_PASSED_OVER == static_cast<int>(hal::Validity::kPassedOver));

void tumblesight_app::boot() {
  hal::CommandKeys keys;
  hal::Platform platform;
  platform.stopwatch = &stopwatch;
  platform.models = &models;
  platform.command_apid = fsw::c::apids_of(settings.apids).command;
  platform.reset_cause = static_cast<hal::ResetCause>(settings.reset_cause);
  if (settings.read_stored != nullptr) platform.persistent = &store;
  const bool has_keys = settings.command_keys != nullptr;
  if (has_keys) {
    for (std::size_t slot = 0; slot < keys.slots.size(); ++slot)
      std::copy_n(settings.command_keys->slots[slot], keys.slots[slot].size(), keys.slots[slot].begin());
    keys.spacecraft_id = settings.command_keys->spacecraft_id;
    platform.command_keys = &keys;
  }
  app.init(platform, settings.expected_target);
  if (has_keys) link.authenticate_with(keys, app.key_slot(), app.command_counter());
  // Both are copied now, and need not stay valid.
  settings.command_keys = nullptr;
  settings.expected_target = nullptr;
}

void tumblesight_app::step(const tumblesight_inputs& inputs) {
  lidar.begin(inputs);
  navigation.begin(inputs);
  link.begin(inputs, outputs);
  fsw::run_cycle(app, {lidar, link, watchdog, stopwatch, &navigation}, inputs.now_ns, inputs.slips,
                 workspace);
  has_stepped = true;
  packets_taken = 0;
}

const hal::packets::TelemetryPacket* tumblesight_app::next_packet() {
  if (!has_stepped) return nullptr;
  const fsw::StepOutputs& messages = workspace.outputs;
  const std::size_t index = packets_taken++;
  if (index == 0) return &encoder.encode(messages.attitude);
  if (index == 1) return &encoder.encode(messages.telemetry);
  const std::size_t event = index - 2;
  if (event < outputs.event_count) return &encoder.encode(messages.events[event]);
  if (event == outputs.event_count && outputs.has_dump) return &encoder.encode(messages.dump);
  packets_taken = index;
  return nullptr;
}

namespace {

constexpr std::size_t kImageAlignment_bytes = 64;

// Up to the next multiple of `alignment_bytes`.
std::size_t bytes_to_aligned(const void* address, std::size_t alignment_bytes) {
  const std::size_t beyond = reinterpret_cast<std::uintptr_t>(address) % alignment_bytes;
  return beyond == 0 ? 0 : alignment_bytes - beyond;
}

Memory memory_of_bank(const tumblesight_bank& bank) {
  const std::size_t capacity_bytes = bank.writable == nullptr ? 0 : bank.capacity_bytes;
  return {bank.image, std::max(bank.image_bytes, capacity_bytes)};
}

tumblesight_status check_bank(const tumblesight_bank& bank) {
  if (bank.writable != nullptr && bank.writable != bank.image) return TUMBLESIGHT_OTHER_ADDRESS;
  if (bytes_to_aligned(bank.image, kImageAlignment_bytes) != 0) return TUMBLESIGHT_MISALIGNED_IMAGE;
  if (bank.writable != nullptr && bank.image_bytes > bank.capacity_bytes) return TUMBLESIGHT_IMAGE_TOO_LARGE;
  return TUMBLESIGHT_OK;
}

// The object overwrites its memory before it has read the rest, and a bank that is loaded must not be part of
// the one in use. `object`: the part of the memory that the object takes.
tumblesight_status check_overlaps(const Memory& object, const tumblesight_settings& settings,
                                  tumblesight_app* const* app) {
  const std::initializer_list<Memory> others{memory_of(&settings),
                                             memory_of(app),
                                             memory_of(settings.command_keys),
                                             memory_of(settings.expected_target),
                                             memory_of_bank(settings.bank[0]),
                                             memory_of_bank(settings.bank[1])};
  for (const Memory& other : others)
    if (overlap(object, other)) return TUMBLESIGHT_OVERLAP;
  const bool banks_overlap = overlap(memory_of_bank(settings.bank[0]), memory_of_bank(settings.bank[1]));
  return banks_overlap ? TUMBLESIGHT_OVERLAP : TUMBLESIGHT_OK;
}
static_assert(TUMBLESIGHT_BANKS == 2);

tumblesight_status check_settings(const tumblesight_settings& settings) {
  if ((settings.read_stored == nullptr) != (settings.write_stored == nullptr))
    return TUMBLESIGHT_NULL_ARGUMENT;
  if (settings.reset_cause < TUMBLESIGHT_RESET_POWER_ON || settings.reset_cause > TUMBLESIGHT_RESET_OTHER)
    return TUMBLESIGHT_BAD_RESET_CAUSE;
  if (!fsw::c::apids_of(settings.apids).are_valid()) return TUMBLESIGHT_BAD_APIDS;
  return first_wrong({status_of_optional(settings.command_keys), check_bank(settings.bank[0]),
                      check_bank(settings.bank[1])});
}

// What is wrong with the arguments of init().
tumblesight_status check(const void* memory, std::size_t memory_bytes, const tumblesight_settings* settings,
                         tumblesight_app* const* app) {
  if (memory == nullptr) return TUMBLESIGHT_NULL_ARGUMENT;
  tumblesight_status status = status_of(settings);
  if (status != TUMBLESIGHT_OK) return status;
  if (memory_bytes < tumblesight_memory_bytes(memory)) return TUMBLESIGHT_TOO_LITTLE_MEMORY;
  status = check_settings(*settings);
  if (status != TUMBLESIGHT_OK) return status;
  return check_overlaps({memory, tumblesight_memory_bytes(memory)}, *settings, app);
}

// What is wrong with the arguments of step().
tumblesight_status check(const tumblesight_app* app, const tumblesight_inputs* inputs,
                         const tumblesight_outputs* const* outputs) {
  const tumblesight_status status =
      first_wrong({status_of(app), status_of(inputs), status_of_optional(outputs)});
  if (status != TUMBLESIGHT_OK) return status;
  if (overlap(memory_of(app), memory_of(outputs))) return TUMBLESIGHT_OVERLAP;
  if (inputs->frames == nullptr && inputs->frame_count > 0) return TUMBLESIGHT_NULL_ARGUMENT;
  if (inputs->commands == nullptr && inputs->command_count > 0) return TUMBLESIGHT_NULL_ARGUMENT;
  if (inputs->frame_count > TUMBLESIGHT_MAX_FRAMES || inputs->command_count > TUMBLESIGHT_MAX_COMMANDS)
    return TUMBLESIGHT_TOO_MANY;
  return first_wrong({status_of_optional(inputs->frames), status_of_optional(inputs->commands)});
}

}  // namespace

const char* tumblesight_status_text(tumblesight_status status) {
  switch (status) {
    case TUMBLESIGHT_OK:
      return "ok";
    case TUMBLESIGHT_NO_MODEL:
      return "no bank holds a model image that passes every check; the mode is SAFE";
    case TUMBLESIGHT_NULL_ARGUMENT:
      return "a pointer that is needed is null";
    case TUMBLESIGHT_TOO_LITTLE_MEMORY:
      return "less memory than tumblesight_memory_bytes() says";
    case TUMBLESIGHT_MISALIGNED_IMAGE:
      return "the address of a model image is not a multiple of 64";
    case TUMBLESIGHT_OTHER_ADDRESS:
      return "the writable address of a bank is not that of its image";
    case TUMBLESIGHT_BAD_RESET_CAUSE:
      return "the reset cause is none of enum tumblesight_reset_cause";
    case TUMBLESIGHT_TOO_MANY:
      return "more frames or commands than one step takes";
    case TUMBLESIGHT_BAD_APIDS:
      return "an APID is above 0x7FE, or two are equal";
    case TUMBLESIGHT_BAD_PARAMETER:
      return "a parameter has a value that is not allowed";
    case TUMBLESIGHT_COMMAND_DROPPED:
      return "the telecommand is not authentic, or no place is free for it; it is counted";
    case TUMBLESIGHT_OVERLAP:
      return "two arguments share memory that must be their own";
    case TUMBLESIGHT_IMAGE_TOO_LARGE:
      return "a model image is larger than the capacity of its bank";
    case TUMBLESIGHT_MISALIGNED_ARGUMENT:
      return "a pointer is not aligned for its type";
  }
  return "unknown status";
}

std::size_t tumblesight_memory_bytes(const void* memory) {
  return bytes_to_aligned(memory, alignof(tumblesight_app)) + sizeof(tumblesight_app);
}

tumblesight_status tumblesight_init(void* memory, std::size_t memory_bytes,
                                    const tumblesight_settings* settings, tumblesight_app** app) {
  tumblesight_status status = status_of(app);
  if (status != TUMBLESIGHT_OK) return status;
  status = check(memory, memory_bytes, settings, app);
  // A pointer that lies in one of the other arguments is not written to.
  if (status != TUMBLESIGHT_OVERLAP) *app = nullptr;
  if (status != TUMBLESIGHT_OK) return status;
  auto* const place = static_cast<std::uint8_t*>(memory) + bytes_to_aligned(memory, alignof(tumblesight_app));
  *app = new (place) tumblesight_app(*settings);
  (*app)->boot();
  return (*app)->app.estimator().has_model() ? TUMBLESIGHT_OK : TUMBLESIGHT_NO_MODEL;
}

tumblesight_status tumblesight_put_command(tumblesight_app* app, const std::uint8_t* bytes,
                                           std::size_t size_bytes) {
  if (bytes == nullptr) return TUMBLESIGHT_NULL_ARGUMENT;
  const tumblesight_status status = status_of(app);
  if (status != TUMBLESIGHT_OK) return status;
  return app->link.put(bytes, size_bytes) ? TUMBLESIGHT_OK : TUMBLESIGHT_COMMAND_DROPPED;
}

tumblesight_status tumblesight_step(tumblesight_app* app, const tumblesight_inputs* inputs,
                                    const tumblesight_outputs** outputs) {
  const tumblesight_status status = check(app, inputs, outputs);
  if (status != TUMBLESIGHT_OK) {
    if (outputs != nullptr && is_aligned(outputs) && status != TUMBLESIGHT_OVERLAP) *outputs = nullptr;
    return status;
  }
  app->step(*inputs);
  if (outputs != nullptr) *outputs = &app->outputs;
  return TUMBLESIGHT_OK;
}

tumblesight_status tumblesight_set_parameters(tumblesight_app* app,
                                              const tumblesight_parameters* parameters) {
  const tumblesight_status status = first_wrong({status_of(app), status_of(parameters)});
  if (status != TUMBLESIGHT_OK) return status;
  return app->app.use(fsw::c::table_of(*parameters)) ? TUMBLESIGHT_OK : TUMBLESIGHT_BAD_PARAMETER;
}

const char* tumblesight_version() {
  return TUMBLESIGHT_VERSION;
}

const char* tumblesight_event_text(std::uint16_t event_id) {
  return hal::text_of(static_cast<hal::EventId>(event_id));
}

std::size_t tumblesight_take_packet(tumblesight_app* app, std::uint8_t* bytes, std::size_t capacity_bytes) {
  if (status_of(app) != TUMBLESIGHT_OK || bytes == nullptr || capacity_bytes < TUMBLESIGHT_MAX_PACKET_BYTES)
    return 0;
  if (overlap(memory_of(app), {bytes, capacity_bytes})) return 0;
  const hal::packets::TelemetryPacket* const packet = app->next_packet();
  if (packet == nullptr) return 0;
  std::copy_n(packet->bytes.begin(), packet->size, bytes);
  return packet->size;
}

std::uint32_t tumblesight_state_crc32(const tumblesight_app* app) {
  return status_of(app) == TUMBLESIGHT_OK ? app->app.state_crc32() : 0;
}

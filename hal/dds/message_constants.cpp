// Checks that the constants of the interface definition have the same values as those of hal/messages.
#include "hal/dds/idl/tumblesight.h"
#include "hal/messages/attitude_report.hpp"
#include "hal/messages/command_packet.hpp"
#include "hal/messages/event_id.hpp"
#include "hal/messages/function_code.hpp"
#include "hal/messages/memory_dump.hpp"
#include "hal/messages/telemetry.hpp"

namespace tumblesight::hal::dds {
namespace {

template <class Enum>
constexpr bool is_value_of(int constant, Enum value) {
  return constant == static_cast<int>(value);
}

static_assert(tumblesight_icd_COMMAND_BYTES == CommandPacket::kMaxBytes);
static_assert(tumblesight_icd_DUMP_BYTES == MemoryDump::kMaxBytes);
static_assert(tumblesight_icd_REFUSALS == kCommandRefusals);
static_assert(tumblesight_icd_CYCLE_TIME_BINS == Telemetry::kCycleTimeBins);
static_assert(tumblesight_icd_BANKS == Telemetry::kBanks);
static_assert(tumblesight_icd_COMMAND_APID == kCommandApid);
static_assert(is_value_of(tumblesight_icd_MODE_STANDBY, Mode::kStandby));
static_assert(is_value_of(tumblesight_icd_MODE_RUN, Mode::kRun));
static_assert(is_value_of(tumblesight_icd_MODE_SAFE, Mode::kSafe));
static_assert(is_value_of(tumblesight_icd_VALIDITY_VALID, Validity::kValid));
static_assert(is_value_of(tumblesight_icd_VALIDITY_DOUBTFUL, Validity::kDoubtful));
static_assert(is_value_of(tumblesight_icd_FUNCTION_NOOP, FunctionCode::kNoop));
static_assert(is_value_of(tumblesight_icd_FUNCTION_RESET_COUNTERS, FunctionCode::kResetCounters));
static_assert(is_value_of(tumblesight_icd_FUNCTION_SET_MODE, FunctionCode::kSetMode));
static_assert(is_value_of(tumblesight_icd_FUNCTION_RESET_SEQUENCE, FunctionCode::kResetSequence));
static_assert(is_value_of(tumblesight_icd_FUNCTION_MODEL_LOAD, FunctionCode::kModelLoad));
static_assert(is_value_of(tumblesight_icd_FUNCTION_MODEL_VALIDATE, FunctionCode::kModelValidate));
static_assert(is_value_of(tumblesight_icd_FUNCTION_MODEL_ACTIVATE, FunctionCode::kModelActivate));
static_assert(is_value_of(tumblesight_icd_FUNCTION_MEMORY_DUMP, FunctionCode::kMemoryDump));
static_assert(is_value_of(tumblesight_icd_FUNCTION_SET_PARAMETER, FunctionCode::kSetParameter));
static_assert(is_value_of(tumblesight_icd_FUNCTION_ENABLE_RESPONSE, FunctionCode::kEnableResponse));
static_assert(is_value_of(tumblesight_icd_FUNCTION_DISABLE_RESPONSE, FunctionCode::kDisableResponse));
static_assert(is_value_of(tumblesight_icd_FUNCTION_KEY_ACTIVATE, FunctionCode::kKeyActivate));
static_assert(is_value_of(tumblesight_icd_FUNCTION_MODEL_BEGIN, FunctionCode::kModelBegin));
static_assert(is_value_of(tumblesight_icd_FUNCTION_TABLE_LOAD, FunctionCode::kTableLoad));
static_assert(is_value_of(tumblesight_icd_FUNCTION_TABLE_VALIDATE, FunctionCode::kTableValidate));
static_assert(is_value_of(tumblesight_icd_FUNCTION_TABLE_ACTIVATE, FunctionCode::kTableActivate));
static_assert(is_value_of(tumblesight_icd_EVENT_MODEL_REFUSED, EventId::kModelRefused));

}  // namespace
}  // namespace tumblesight::hal::dds

// The cFS app with a mission's own headers.
#include <gtest/gtest.h>

#include "hal/messages/function_code.hpp"
#include "tests/support/make_packet.hpp"
#include "tests/support/stubs/cfe/cfe_stub.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

extern "C" {
#include "tumblesight_app.h"
#include "tumblesight_app_eventids.h"
#include "tumblesight_app_msgids.h"
}

namespace tumblesight::fsw {
namespace {

TEST(CfsAppWithOtherHeaders, UsesTheMissionsIdsFilesAndTarget) {
  cfe::restart_cfe();
  cfe::Cfe& the = cfe::the_cfe();
  the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = test_model_image();
  the.failing["CFE_TBL_Load:" TUMBLESIGHT_APP_TABLE_FILE] = CFE_TBL_ERR_ACCESS;
  std::vector<std::uint8_t> noop = packet_of(static_cast<std::uint8_t>(hal::FunctionCode::kNoop));
  noop[0] = TUMBLESIGHT_APP_CMD_MID >> 8;
  noop[1] = TUMBLESIGHT_APP_CMD_MID & 0xFF;
  set_checksum(noop);
  the.deliver(noop);
  the.deliver(cfe::make_message(TUMBLESIGHT_APP_WAKEUP_MID, 8), [&the] { the.met_ns = kStart_ns; });
  TUMBLESIGHT_Main();
  EXPECT_EQ(the.count_events(TUMBLESIGHT_APP_NO_MODEL_ERR_EID), 0) << "its target is the expected one";
  EXPECT_EQ(the.count_events(static_cast<int>(hal::EventId::kCommandAccepted)), 1);
  ASSERT_GE(the.sent.size(), 3U);
  EXPECT_EQ(the.sent[0].message_id(), static_cast<std::uint32_t>(TUMBLESIGHT_APP_ATTITUDE_MID));
  EXPECT_EQ(the.sent[1].message_id(), static_cast<std::uint32_t>(TUMBLESIGHT_APP_TLM_MID));
  EXPECT_EQ(the.sent[2].message_id(), static_cast<std::uint32_t>(TUMBLESIGHT_APP_EVENT_MID));
}

// This mission's support package tells a command from an exception.
TEST(CfsAppWithOtherHeaders, GoesOnInRunAfterACommandedReset) {
  for (const auto& [subtype, mode] :
       {std::pair{CFE_PSP_RST_SUBTYPE_RESET_COMMAND, 2}, std::pair{CFE_PSP_RST_SUBTYPE_EXCEPTION, 1}}) {
    cfe::restart_cfe();
    cfe::Cfe& the = cfe::the_cfe();
    the.files[TUMBLESIGHT_APP_MODEL_FILE_0] = test_model_image();
    the.failing["CFE_TBL_Load:" TUMBLESIGHT_APP_TABLE_FILE] = CFE_TBL_ERR_ACCESS;
    for (const int type : {CFE_PSP_RST_TYPE_POWERON, CFE_PSP_RST_TYPE_PROCESSOR}) {
      the.reset_type = type;
      the.reset_subtype = static_cast<std::uint32_t>(subtype);
      the.stored_names.clear();
      the.sent.clear();
      the.deliver(cfe::make_message(TUMBLESIGHT_APP_WAKEUP_MID, 8), [&the] { the.met_ns += kStart_ns; });
      TUMBLESIGHT_Main();
    }
    constexpr std::size_t kModeOffset = 14 + 8;  // behind the header and time_ns
    EXPECT_EQ(the.sent[1].bytes[kModeOffset], mode) << "after subtype " << subtype;
  }
}

}  // namespace
}  // namespace tumblesight::fsw

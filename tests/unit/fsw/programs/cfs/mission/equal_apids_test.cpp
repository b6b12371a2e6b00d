// The cFS app with message ids that cannot be.
#include <gtest/gtest.h>

#include "tests/support/stubs/cfe/cfe_stub.hpp"

extern "C" {
#include "tumblesight_app.h"
#include "tumblesight_app_eventids.h"
}

namespace tumblesight::cfe {
namespace {

TEST(CfsAppWithEqualApids, DoesNotStart) {
  restart_cfe();
  the_cfe().deliver(make_message(0x19F2, 8));
  TUMBLESIGHT_Main();
  EXPECT_EQ(the_cfe().exit_status, static_cast<std::uint32_t>(CFE_ES_RunStatus_APP_ERROR));
  EXPECT_EQ(the_cfe().text_of(TUMBLESIGHT_APP_INIT_ERR_EID),
            "TUMBLESIGHT: not started: an APID is above 0x7FE, or two are equal");
}

}  // namespace
}  // namespace tumblesight::cfe

// --peers says what to install.
#include "sim/cli/evaluate_arguments.hpp"

#include <gtest/gtest.h>

namespace tumblesight::sim {
namespace {

std::unique_ptr<PosePeer> none(const TriangleMesh&, double) {
  return nullptr;
}

constexpr PosePeerRow kPresent{"here", "Here", nullptr, none};
constexpr PosePeerRow kAbsent{"gone", "Gone", "built without Gone: install libgone-dev", nullptr};

// Verifies TS-SIL-180.
TEST(MissingPeers, AreNamedWithTheirPackage) {
  EXPECT_TRUE(missing_peers({kPresent}).empty());
  const std::vector<std::string> lines = missing_peers({kPresent, kAbsent});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0], "built without Gone: install libgone-dev");
}

// Verifies TS-SIL-180.
TEST(MissingPeers, AreRefusedIfThereAreNoOthers) {
  try {
    (void)missing_peers({kAbsent, kAbsent});
    FAIL() << "no exception";
  } catch (const ArgumentFault& error) {
    EXPECT_NE(std::string(error.what())
                  .find("--peers: this build has none of the peers:\n  built without Gone: install"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace tumblesight::sim

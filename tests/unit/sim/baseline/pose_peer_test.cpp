// Each peer finds the attitude of a shape without symmetry, or names the package that this build lacks.
#include "sim/baseline/pose_peer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sim/world/math/angles.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "tests/unit/sim/baseline/jointed_arm.hpp"

namespace tumblesight::sim {
namespace {

class EveryPeer : public ::testing::TestWithParam<PosePeerRow> {
 protected:
  void SetUp() override {
    if (GetParam().missing != nullptr) GTEST_SKIP() << GetParam().missing;
    peer_ = GetParam().make(mesh_, swath_m(mesh_));
  }

  void expose(const FrameTruth& truth, gnc::RangeImage& frame) const {
    SensorSettings settings;
    settings.noise = false;
    lidar_.expose(truth, settings, swath_m(mesh_), 1, frame);
  }

  TriangleMesh mesh_ = jointed_arm();
  FlashLidar lidar_{mesh_};
  std::unique_ptr<PosePeer> peer_;
  std::unique_ptr<gnc::RangeImage> frame_ = std::make_unique<gnc::RangeImage>();
};

// Verifies TS-SIL-180.
TEST_P(EveryPeer, FindsMostNoiseFreeAttitudes) {
  constexpr int kFrames = 8;
  int found = 0;
  for (int i = 0; i < kFrames; ++i) {
    const FrameTruth truth = make_sequence({}, 31, static_cast<std::uint64_t>(i)).frames[0];
    expose(truth, *frame_);
    const PosePeer::Result result = peer_->match(*frame_);
    const double error_deg = kDegPerRad * truth.q_lrf_trf.angularDistance(result.q_lrf_trf);
    found += result.valid && error_deg < 5.0 ? 1 : 0;
  }
  EXPECT_GE(found, kFrames - 2);
}

TEST_P(EveryPeer, GivesTheSameAttitudeAgain) {
  expose(make_sequence({}, 31, 1).frames[0], *frame_);
  const PosePeer::Result once = peer_->match(*frame_);
  const PosePeer::Result again = peer_->match(*frame_);
  EXPECT_EQ(once.valid, again.valid);
  EXPECT_EQ(once.q_lrf_trf.coeffs(), again.q_lrf_trf.coeffs());
}

TEST_P(EveryPeer, FindsNothingInAFrameThatShowsNoTarget) {
  expose(make_sequence({}, 31, 1).frames[0], *frame_);
  frame_->ranges.fill(0);
  EXPECT_FALSE(peer_->match(*frame_).valid);
}

std::string key_of(const ::testing::TestParamInfo<PosePeerRow>& info) {
  return info.param.key;
}
INSTANTIATE_TEST_SUITE_P(PosePeers, EveryPeer, ::testing::ValuesIn(pose_peers()), key_of);

TEST(PosePeers, AreThereOrNameTheirPackage) {
  ASSERT_EQ(pose_peers().size(), 2U);
  for (const PosePeerRow& peer : pose_peers()) {
    EXPECT_EQ(peer.make == nullptr, peer.missing != nullptr) << peer.key;
    if (peer.missing == nullptr) continue;
    EXPECT_NE(std::string(peer.missing).find("install lib"), std::string::npos) << peer.missing;
  }
}

}  // namespace
}  // namespace tumblesight::sim

// Every single bit of the application's memory, one after the other: corrected and counted, or never read
// before it is written.
#include <cstring>
#include <vector>

#include "tests/support/app_memory.hpp"
#include "tests/support/test_models.hpp"
#include "tests/support/trials.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class EveryBit : public AppFixture {
 protected:
  EveryBit() {
    init_with_model();
    step_good();
    step_good();
    AppMemory::state(*app).table[Parameter::kScrubBlocks] = 1;  // a fast step
    AppMemory::commit(*app);
    keep();
  }
  // Takes the application as it is now as the one that every trial starts with.
  void keep() {
    const Region whole = AppMemory::region_of(*app);
    before_.assign(whole.data, whole.data + whole.size);
  }
  void put_back() { std::memcpy(static_cast<void*>(app.get()), before_.data(), before_.size()); }
  // A cycle without a frame, always at the same time.
  const hal::Telemetry& cycle(int number = 1) {
    app->step(now_ns + number * config::kFramePeriod_ns, StepInputs{}, *out);
    return out->telemetry;
  }
  std::vector<std::uint8_t> bytes_of(Region region) { return {region.data, region.data + region.size}; }

 private:
  std::vector<std::uint8_t> before_;
};

// Verifies TS-FDIR-010. One flip per cycle, so that each also shows that those before it have left the vote
// in order.
TEST_F(EveryBit, OfTheVotedStateIsCorrectedAndCountedAndSoIsTheNextOne) {
  const Region region = AppMemory::redundant_state(*app);
  std::uint32_t flips = 0;
  for (std::size_t bit = 0; bit < 8 * region.size; bit += kBitStride) {
    region.flip(bit);
    ++flips;
    ASSERT_EQ(cycle(static_cast<int>(flips)).memory_corrections, flips) << bit;
    ASSERT_EQ(app->mode(), Mode::kRun) << bit;
  }
  AppMemory::state(*app).counters.memory_corrections = 0;  // the only trace that the flips leave
  const std::uint32_t disturbed = app->state_crc32();
  put_back();
  for (std::uint32_t i = 1; i <= flips; ++i) cycle(static_cast<int>(i));
  EXPECT_EQ(disturbed, app->state_crc32()) << "a bit was corrected to the wrong value";
}

// Verifies TS-FDIR-020.
TEST_F(EveryBit, OfTheEstimatorsStateIsRestoredOrPadding) {
  const std::uint32_t undisturbed = estimator_crc();
  std::size_t restored = 0;
  for (std::size_t bit = 0; bit < AppMemory::kStateBits; bit += kBitStride) {
    put_back();
    AppMemory::flip_state_bit(*app, bit);
    const bool seen = estimator_crc() != undisturbed;
    ASSERT_EQ(cycle(1).states_restored, seen ? 1U : 0U) << bit;
    ASSERT_EQ(estimator_crc(), undisturbed) << bit;
    restored += seen ? 1U : 0U;
    if (!seen) continue;
    AppMemory::flip_state_bit(*app, bit);
    ASSERT_EQ(cycle(2).states_restored, 2U) << bit;
  }
  EXPECT_GT(restored, AppMemory::kStateBits / kBitStride * 9 / 10);
}

// Verifies TS-FDIR-020.
TEST_F(EveryBit, OfTheCopyOfTheEstimatorsStateIsRewrittenInTheSameCycle) {
  const Region copy = AppMemory::kept_state(*app);
  cycle();
  const std::vector<std::uint8_t> undisturbed = bytes_of(copy);
  for (std::size_t bit = 0; bit < 8 * copy.size; bit += kBitStride) {
    put_back();
    copy.flip(bit);
    ASSERT_EQ(cycle().states_lost, 0U) << bit;
    ASSERT_EQ(bytes_of(copy), undisturbed) << bit;
  }
}

// Verifies TS-FDIR-030, TS-FDIR-080. The constants are checked and reloaded; all other memory of the
// estimator is written by each frame before it is read.
TEST_F(EveryBit, OfTheEstimatorIsReloadedRestoredOrRewritten) {
  Estimator& estimator = AppMemory::estimator(*app);
  const Region whole = AppMemory::region_of(estimator), activations = AppMemory::activations(*app);
  const std::uint32_t constants = estimator.constants_crc32(), state = estimator_crc();
  const std::vector<std::uint8_t> before = bytes_of(whole);
  const std::size_t first_activation = static_cast<std::size_t>(activations.data - whole.data);
  std::vector<std::size_t> unseen;
  std::size_t reloaded = 0;
  for (std::size_t bit = 0; bit < 8 * whole.size; ++bit) {
    const std::size_t byte = bit / 8;
    if (byte >= first_activation && byte < first_activation + activations.size) continue;
    if (bit % 8 ==
        0) {  // a CRC detects every change of one byte, so one look tells whether it covers the byte
      whole.data[byte] ^= 0xFF;
      const bool covered = estimator.constants_crc32() != constants || estimator_crc() != state;
      whole.data[byte] ^= 0xFF;
      if (!covered) {
        for (std::size_t i = 0; i < 8; ++i) unseen.push_back(bit + i);
        bit += 7;
        continue;
      }
    }
    if (bit % kBitStride != 0) continue;
    whole.flip(bit);
    if (estimator.constants_crc32() != constants) {
      ++reloaded;
      estimator.reload(store.banks[0].memory.data());
      ASSERT_EQ(estimator.constants_crc32(), constants) << bit;
      std::memcpy(whole.data, before.data(), whole.size);
      continue;
    }
    ASSERT_NE(estimator_crc(), state) << bit;
    whole.flip(bit);
  }
  EXPECT_GT(reloaded, 8U * 5'000 / kBitStride);

  StepInputs inputs;
  const gnc::RangeImage frame = next_frame();
  inputs.frame = &frame;
  app->step(next_time_ns(), inputs, *out);
  const hal::AttitudeReport undisturbed = out->attitude;
  ASSERT_EQ(undisturbed.validity, Validity::kValid);
  put_back();
  for (const std::size_t bit : unseen) whole.flip(bit);
  for (std::size_t bit = 0; bit < 8 * activations.size; ++bit) activations.flip(bit);
  const Region workspace = AppMemory::workspace(*app);
  for (std::size_t bit = 0; bit < 8 * workspace.size; ++bit) workspace.flip(bit);
  app->step(next_time_ns(), inputs, *out);
  EXPECT_EQ(out->attitude.validity, Validity::kValid);
  EXPECT_EQ(out->attitude.q_lrf_trf, undisturbed.q_lrf_trf);
  EXPECT_EQ(out->attitude.q_lrf_trf_single_frame, undisturbed.q_lrf_trf_single_frame);
  EXPECT_EQ(out->attitude.predicted_error_urad, undisturbed.predicted_error_urad);
  EXPECT_EQ(out->telemetry.constants_reloaded, 0U);
}

// Verifies TS-FDIR-010. The platform may reuse the memory of what it hands over.
TEST_F(EveryBit, OfKeyAndTargetNameIsInTheVotedState) {
  hal::CommandKeys keys = kTestKeys;
  std::string target = kTestTarget;
  boot(*app, {&stopwatch, &store, &keys, nullptr, hal::ResetCause::kPowerOn}, target.c_str());
  keys = {};
  target.assign(target.size(), '?');
  step_commands({set_mode(Mode::kStandby)});
  EXPECT_EQ(app->mode(), Mode::kStandby) << "the command is authentic by the key of init()";
  std::vector<std::uint8_t> arguments;
  append_u32(arguments, gnc::model_image_crc32(test_model_image().data()));
  step_commands({command(FunctionCode::kModelActivate, arguments)});
  EXPECT_EQ(out->telemetry.bank_in_use, 1U) << "the target is that of init()";
}

}  // namespace

// Verifies TS-FDIR-040.
TEST(EveryBitOfTheTables, IsDetected) {
  hal::fake::FakeModelStore store;
  store.fill(test_model_image());
  ModelBanks banks;
  ModelBanksState state;
  for (const std::uint32_t bank : {0U, 1U}) banks.make_table(bank, store, state);
  ASSERT_TRUE(banks.table_is_sound(0, state) && banks.table_is_sound(1, state));
  for (std::size_t bit = 0; bit < 8 * sizeof banks; ++bit) {
    AppMemory::region_of(banks).flip(bit);
    const bool in_second = bit / 8 >= sizeof banks / 2;
    ASSERT_EQ(banks.table_is_sound(0, state), in_second) << bit;
    ASSERT_EQ(banks.table_is_sound(1, state), !in_second) << bit;
    AppMemory::region_of(banks).flip(bit);
  }
}

}  // namespace tumblesight::fsw

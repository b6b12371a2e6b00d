// Models in flash: writes that take time, and writes that fail.
// Verifies TS-MDL-060.
#include "hal/fake/fake_flash_store.hpp"
#include "tests/support/test_models.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class FlashStore : public AppFixture {
 protected:
  FlashStore() { init(flash); }

  hal::CommandPacket segment(std::uint32_t offset) {
    std::vector<std::uint8_t> arguments;
    append_u32(arguments, offset);
    const auto end = std::min<std::size_t>(other.size(), offset + std::size_t{kSegmentBytes});
    arguments.insert(arguments.end(), other.begin() + offset,
                     other.begin() + static_cast<std::ptrdiff_t>(end));
    return command(FunctionCode::kModelLoad, arguments);
  }
  hal::CommandPacket begin(UploadBase base = UploadBase::kNothing) {
    return command(FunctionCode::kModelBegin, {static_cast<std::uint8_t>(base)});
  }
  hal::CommandPacket validate() {
    std::vector<std::uint8_t> arguments;
    append_u32(arguments, static_cast<std::uint32_t>(other.size()));
    append_u32(arguments, gnc::model_image_crc32(other.data()));
    return command(FunctionCode::kModelValidate, arguments);
  }
  hal::CommandPacket activate() {
    std::vector<std::uint8_t> arguments;
    append_u32(arguments, gnc::model_image_crc32(other.data()));
    return command(FunctionCode::kModelActivate, arguments);
  }
  void finish() {
    for (int i = 0; i < flash.erase_ticks + flash.write_ticks; ++i) flash.tick();
  }
  std::uint32_t refused_by(CommandRefusal why) const {
    return out->telemetry.commands_refused_by[static_cast<std::size_t>(why)];
  }

  std::vector<std::uint8_t> other = gnc::lasting_model_image<gnc::FixedPoint>(8);
  hal::fake::FakeFlashStore flash{test_model_image()};
};

TEST_F(FlashStore, ModelIsLoadedSegmentBySegmentWhileTheGroundWaitsForEach) {
  flash.erase_ticks = 1;
  std::uint32_t offset = 0;
  std::uint32_t waits = 0;
  step_commands({begin()});
  while (offset < other.size()) {
    step_commands({segment(offset)});
    if (refused_by(CommandRefusal::kBusy) > waits) {
      waits = refused_by(CommandRefusal::kBusy);
      ASSERT_EQ(argument(EventId::kCommandBusy, 2), static_cast<std::int32_t>(offset)) << "to send again";
    } else {
      ASSERT_EQ(out->telemetry.commands_refused, waits);
      offset += kSegmentBytes;
    }
    flash.tick();
  }
  EXPECT_GT(waits, 0U);
  finish();
  step_commands({set_mode(Mode::kStandby), validate()});
  step_commands({activate()});
  EXPECT_EQ(out->telemetry.bank_in_use, 1);
  EXPECT_EQ(app->estimator().model().crc32, gnc::model_image_crc32(other.data()));
}

TEST_F(FlashStore, BankThatIsBeingWrittenIsNotReadButFramesContinue) {
  step_commands({set_mode(Mode::kStandby), begin(), segment(0)});
  EXPECT_EQ(out->telemetry.bank_activity[1], hal::BankActivity::kErasing);
  step_commands({command(FunctionCode::kMemoryDump, {1, 0, 0, 0, 0, 0, 4}), set_mode(Mode::kRun)});
  EXPECT_EQ(refused_by(CommandRefusal::kBusy), 1U);
  EXPECT_FALSE(out->has_dump);
  step_commands({command(FunctionCode::kMemoryDump, {2, 0, 0, 0, 0, 0, 4})});
  EXPECT_TRUE(out->has_dump) << "the bitmap of the missing segments is not in the bank";
  flash.tick();
  flash.tick();
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->telemetry.bank_activity[1], hal::BankActivity::kWriting);
  EXPECT_EQ(out->telemetry.model_blocks_lost, 0U);
  flash.tick();
  step_commands({command(FunctionCode::kMemoryDump, {1, 0, 0, 0, 0, 0, 4})});
  EXPECT_TRUE(out->has_dump);
  EXPECT_EQ(out->telemetry.bank_activity[1], hal::BankActivity::kReady);
}

TEST_F(FlashStore, ValidateAndActivateWaitForTheLastWrite) {
  flash.erase_ticks = flash.write_ticks = 0;
  std::uint32_t offset = 0;
  step_commands({begin()});
  for (; offset + hal::kMaxModelSegmentBytes < other.size(); offset += hal::kMaxModelSegmentBytes)
    step_commands({segment(offset)});
  flash.write_ticks = 1;
  step_commands({set_mode(Mode::kStandby), segment(offset), validate()});
  EXPECT_EQ(refused_by(CommandRefusal::kBusy), 1U);
  finish();
  step_commands({validate()});
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood);
  // Something else writes to the bank between validation and activation.
  const std::uint8_t byte = other[0];
  ASSERT_EQ(flash.write(1, 0, &byte, 1), hal::WriteStatus::kAccepted);
  step_commands({activate()});
  EXPECT_EQ(refused_by(CommandRefusal::kBusy), 2U);
  finish();
  step_commands({activate()});
  EXPECT_EQ(out->telemetry.bank_in_use, 1);
}

TEST_F(FlashStore, FailedWriteMakesTheImageVoidAndANewOneBegins) {
  flash.erase_ticks = flash.write_ticks = 0;
  step_commands({begin(), segment(0)});
  flash.fail_next = true;
  step_commands({segment(1024)});
  EXPECT_EQ(out->telemetry.commands_refused, 0U) << "flash finds the failure later";
  EXPECT_EQ(out->telemetry.bank_activity[1], hal::BankActivity::kFailed);
  step_commands({segment(2048)});
  EXPECT_EQ(refused_by(CommandRefusal::kStoreFailed), 1U);
  EXPECT_EQ(events(EventId::kCommandStoreFailed), 1);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kEmpty);
  EXPECT_EQ(out->telemetry.model_segments_missing, 0U) << "nothing is being loaded";
  step_commands({command(FunctionCode::kMemoryDump, {1, 0, 0, 0, 0, 0, 4})});
  EXPECT_EQ(refused_by(CommandRefusal::kStoreFailed), 2U);
  step_commands({segment(0), begin(), segment(1024), segment(0)});
  EXPECT_EQ(events(EventId::kCommandNoModel), 1);
  EXPECT_EQ(out->telemetry.model_segments_missing, kModelSegments - 2);
  EXPECT_EQ(out->telemetry.bank_in_use, 0);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid) << "the model in use is not concerned";
}

// Verifies TS-MDL-080.
TEST_F(FlashStore, ImageInUseIsCopiedSectorBySectorWhileTheGroundSendsTheChanges) {
  flash.banks[1].cells.assign(other.size(), 0x55);
  flash.banks[1].visible = flash.banks[1].cells;
  flash.erase_ticks = 1;
  const std::vector<std::uint8_t> changed = gnc::with_changed_weights(test_model_image(), {300'000});
  std::vector<std::uint32_t> to_send;
  for (std::uint32_t offset = 0; offset < changed.size(); offset += kSegmentBytes) {
    const auto end = changed.begin() + std::min<std::ptrdiff_t>(offset + kSegmentBytes, other.size());
    if (!std::equal(changed.begin() + offset, end, test_model_image().begin() + offset))
      to_send.push_back(offset);
  }
  other = changed;
  step_commands({set_mode(Mode::kStandby), begin(UploadBase::kBankInUse)});
  int cycles = 0;
  for (; out->telemetry.model_segments_missing > 0; ++cycles) {
    flash.tick();
    const std::uint32_t refused = out->telemetry.commands_refused;
    if (to_send.empty()) {
      step(StepInputs{});
    } else {
      step_commands({segment(to_send.back())});
      if (out->telemetry.commands_refused == refused) to_send.pop_back();
    }
    ASSERT_EQ(out->telemetry.commands_refused_by[static_cast<std::size_t>(CommandRefusal::kStoreFailed)], 0U);
  }
  EXPECT_TRUE(to_send.empty()) << "commands go before the copy";
  EXPECT_LT(cycles, 2 * 330) << "four segments are written together";
  finish();
  step_commands({validate()});
  step_commands({activate()});
  EXPECT_EQ(out->telemetry.bank_in_use, 1);
  EXPECT_EQ(flash.banks[1].cells, changed);
}

// Verifies TS-MDL-080.
TEST_F(FlashStore, FailedWriteOfACopyMakesTheImageVoid) {
  flash.erase_ticks = flash.write_ticks = 0;
  flash.fail_next = true;
  step_commands({begin(UploadBase::kBankInUse)});
  step(StepInputs{});
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kEmpty);
  EXPECT_EQ(out->telemetry.model_segments_missing, 0U);
}

TEST_F(FlashStore, DeadFlashRefusesAtOnce) {
  flash.dead = true;
  step_commands({begin(), segment(0)});
  EXPECT_EQ(refused_by(CommandRefusal::kStoreFailed), 1U);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kEmpty);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
}

TEST_F(FlashStore, DamagedSecondCopyIsRepairedInTheBackground) {
  flash.banks[1].cells[5000] ^= 1;
  flash.banks[1].visible = flash.banks[1].cells;
  int repaired = 0;
  for (int i = 0; i < 60; ++i) {
    step_good();
    repaired += events(EventId::kModelRepaired);
    flash.tick();
    ASSERT_EQ(validity(), Validity::kValid);
  }
  EXPECT_EQ(repaired, 1);
  EXPECT_EQ(flash.banks[1].cells, test_model_image());
  EXPECT_EQ(out->telemetry.model_blocks_lost, 0U);
}

// Verifies TS-FDIR-047.
TEST_F(FlashStore, DamagedSecondCopyThatCannotBeWrittenIsReportedAsLost) {
  step_good();
  flash.dead = true;
  flash.banks[1].visible[9] ^= 1;
  int lost = 0;
  for (int i = 0; i < 30; ++i) {
    step_good();
    lost += events(EventId::kFallbackLost);
  }
  EXPECT_EQ(lost, 1);
  EXPECT_EQ(out->telemetry.bank_status[1], hal::BankStatus::kEmpty);
  EXPECT_EQ(app->mode(), Mode::kRun);
}

// Verifies TS-FDIR-040.
TEST_F(FlashStore, RepairThatFailsIsRepeated) {
  step_good();
  flash.fail_next = true;
  flash.banks[1].cells[9] ^= 1;
  flash.banks[1].visible[9] ^= 1;
  for (int i = 0; i < 60; ++i) {
    step_good();
    flash.tick();
  }
  EXPECT_EQ(flash.banks[1].visible, test_model_image());
  EXPECT_EQ(out->telemetry.model_blocks_repaired, 3U)
      << "the block whose write fails, the one that shows the failure, and the first one again";
  EXPECT_EQ(out->telemetry.second_copy, 1U);
}

// In memory that should be written at once.
TEST_F(FlashStore, ImageInUseThatCannotBeRepairedIsReplacedByTheSecondCopy) {
  init_with_model();
  store.banks[0].memory[5000] ^= 1;
  store.banks[0].dead = true;
  for (int i = 0; i < 30 && out->telemetry.bank_switches == 0; ++i) step_good();
  EXPECT_EQ(out->telemetry.bank_in_use, 1);
}

TEST_F(FlashStore, DamagedImageInUseIsReplacedByTheSecondCopyBecauseItMustStayReadable) {
  flash.banks[0].cells[5000] ^= 1;
  flash.banks[0].visible = flash.banks[0].cells;
  for (int i = 0; i < 30 && out->telemetry.bank_switches == 0; ++i) {
    step_good();
    flash.tick();
  }
  EXPECT_EQ(out->telemetry.bank_switches, 1U);
  EXPECT_EQ(out->telemetry.bank_in_use, 1);
  EXPECT_EQ(flash.banks[0].visible, flash.banks[0].cells) << "it was never written";
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
}

}  // namespace
}  // namespace tumblesight::fsw

// Loading, validating, activating and dumping models.
// Verifies TS-MDL-020, TS-MDL-030, TS-MDL-040, TS-MDL-050.
#include <algorithm>

#include "tests/support/test_models.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class ModelCommands : public AppFixture {
 protected:
  ModelCommands() : other(gnc::lasting_model_image<gnc::FixedPoint>(8)) { init_with_model(); }

  hal::CommandPacket segment(std::uint32_t offset, std::size_t size) {
    std::vector<std::uint8_t> arguments;
    append_u32(arguments, offset);
    arguments.insert(arguments.end(), other.begin() + offset,
                     other.begin() + offset + static_cast<std::ptrdiff_t>(size));
    return command(FunctionCode::kModelLoad, arguments);
  }
  // Loads all of `other`, eight segments per cycle, while frames continue.
  void load_all() {
    std::uint32_t offset = 0;
    while (offset < other.size()) {
      StepInputs inputs;
      for (; inputs.command_count < config::kMaxCommandsPerStep && offset < other.size();
           ++inputs.command_count) {
        const std::size_t size = std::min<std::size_t>(hal::kMaxModelSegmentBytes, other.size() - offset);
        inputs.commands[static_cast<std::size_t>(inputs.command_count)] = segment(offset, size);
        offset += static_cast<std::uint32_t>(size);
      }
      const gnc::RangeImage frame = next_frame();
      sequence_number = frame.sequence_number;
      inputs.frame = &frame;
      step(inputs);
      ASSERT_EQ(events(EventId::kCommandWrongArgument), 0);
    }
    ASSERT_EQ(out->telemetry.model_bytes_loaded, other.size());
  }
  hal::CommandPacket validate(std::uint32_t size, std::uint32_t crc32) {
    std::vector<std::uint8_t> arguments;
    append_u32(arguments, size);
    append_u32(arguments, crc32);
    return command(FunctionCode::kModelValidate, arguments);
  }
  hal::CommandPacket validate() {
    return validate(static_cast<std::uint32_t>(other.size()), gnc::model_image_crc32(other.data()));
  }
  hal::CommandPacket activate(std::uint32_t crc32) {
    std::vector<std::uint8_t> arguments;
    append_u32(arguments, crc32);
    return command(FunctionCode::kModelActivate, arguments);
  }
  hal::CommandPacket activate() { return activate(gnc::model_image_crc32(other.data())); }
  hal::CommandPacket dump(std::uint8_t bank, std::uint32_t offset, std::uint16_t size) {
    std::vector<std::uint8_t> arguments{bank};
    append_u32(arguments, offset);
    append_u16(arguments, size);
    return command(FunctionCode::kModelDump, arguments);
  }

  const std::vector<std::uint8_t>& other;
};

// A platform that reports the capacity of a bank that does not exist.
class HollowStore final : public hal::ModelStore {
 public:
  explicit HollowStore(hal::ModelStore& store) : store_(store) {}
  hal::ModelBank bank(int index) override {
    return index == 0 ? store_.bank(0) : hal::ModelBank{nullptr, hal::BankWriting::kReadOnly, 0, 4096};
  }

 private:
  hal::ModelStore& store_;
};

TEST_F(ModelCommands, NewModelIsLoadedInFlightValidatedActivatedAndRun) {
  load_all();
  EXPECT_EQ(validity(), Validity::kValid) << "the old model runs while the new one is loaded";
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kLoading);
  step_commands({set_mode(Mode::kStandby), validate()});
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood);
  step_commands({activate(), set_mode(Mode::kRun)});
  EXPECT_EQ(argument(EventId::kModelActivated, 1), 1);
  EXPECT_EQ(out->telemetry.bank_in_use, 1);
  EXPECT_EQ(app->estimator().model().crc32, gnc::model_image_crc32(other.data()));
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 1U);
  EXPECT_EQ(out->telemetry.second_copy, 0);
  // Back to the old model, which is still in its bank.
  step_commands({set_mode(Mode::kStandby), activate(gnc::model_image_crc32(test_model_image().data()))});
  EXPECT_EQ(out->telemetry.bank_in_use, 0);
}

TEST_F(ModelCommands, SegmentsOutOfOrderOrBeyondTheBankAreRefusedWithTheNextOffset) {
  step_commands({segment(0, 1000), segment(2000, 10)});
  EXPECT_EQ(argument(EventId::kCommandWrongArgument, 2), 1000);
  EXPECT_EQ(out->telemetry.model_bytes_loaded, 1000U);
  step_commands({segment(1000, 24)});
  EXPECT_EQ(out->telemetry.model_bytes_loaded, 1024U);
  step_commands({segment(0, 5)});
  EXPECT_EQ(out->telemetry.model_bytes_loaded, 5U) << "offset 0 begins a new image";
  std::vector<std::uint8_t> far{0xFF, 0xFF, 0xFF, 0xFF, 1};
  step_commands({command(FunctionCode::kModelLoad, far)});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
}

TEST_F(ModelCommands, SegmentBeyondTheEndOfTheBankIsRefused) {
  store.banks[1] = {std::vector<std::uint8_t>(1500), 0, true};
  init(store);
  step_commands({segment(0, 1024), segment(1024, 476), segment(1500, 1)});
  EXPECT_EQ(out->telemetry.commands_accepted, 2U);
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
}

TEST_F(ModelCommands, SegmentLargerThanTheBankIsRefused) {
  store.banks[1] = {std::vector<std::uint8_t>(2), 0, true};
  init(store);
  step_commands({segment(0, 3)});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
  step_commands({segment(0, 2)});
  EXPECT_EQ(events(EventId::kCommandAccepted), 1);
}

TEST_F(ModelCommands, ValidatedImageIsNeitherContinuedNorValidatedAgain) {
  store.banks[1].memory.resize(other.size() + 10);
  load_all();
  step_commands({set_mode(Mode::kStandby), validate(), validate()});
  EXPECT_EQ(events(EventId::kCommandAccepted), 2);
  EXPECT_EQ(events(EventId::kCommandNoModel), 1);
  step_commands({command(FunctionCode::kModelLoad, {0, static_cast<std::uint8_t>(other.size() >> 16),
                                                    static_cast<std::uint8_t>(other.size() >> 8),
                                                    static_cast<std::uint8_t>(other.size()), 1})});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood);
}

TEST_F(ModelCommands, ReadOnlyBankRefusesSegments) {
  store.banks[1].writable = false;
  init(store);
  step_commands({segment(0, 10)});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood) << "the bank still holds the second copy";
}

TEST_F(ModelCommands, DamagedWrongOrUnfinishedImagesAreNotValidated) {
  step_commands({set_mode(Mode::kStandby), validate()});
  EXPECT_EQ(events(EventId::kCommandNoModel), 1) << "nothing has been loaded";
  load_all();
  step_commands(
      {validate(static_cast<std::uint32_t>(other.size()) - 1, gnc::model_image_crc32(other.data()))});
  EXPECT_EQ(events(EventId::kCommandNoModel), 1) << "another size";
  EXPECT_EQ(events(EventId::kModelRefused), 0) << "the image was not checked";
  step_commands({validate(static_cast<std::uint32_t>(other.size()), 1)});
  EXPECT_EQ(argument(EventId::kCommandNoModel, 2), static_cast<int>(gnc::ModelStatus::kBadHeaderCrc));
  step_commands({activate(0)});
  EXPECT_EQ(events(EventId::kCommandNoModel), 1) << "an image that is being loaded has no CRC yet";
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kLoading);
  store.banks[1].memory[500'000] ^= 4;
  step_commands({validate(static_cast<std::uint32_t>(other.size()), 1)});
  EXPECT_EQ(argument(EventId::kCommandNoModel, 2), static_cast<int>(gnc::ModelStatus::kBadSectionCrc))
      << "the image is checked first";
  step_commands({validate()});
  EXPECT_EQ(argument(EventId::kModelRefused, 0), static_cast<int>(gnc::ModelStatus::kBadSectionCrc));
  EXPECT_EQ(argument(EventId::kModelRefused, 2), 1);
  step_commands({activate()});
  EXPECT_EQ(events(EventId::kCommandNoModel), 1) << "only a validated image is activated";
  EXPECT_EQ(out->telemetry.bank_in_use, 0);
}

TEST_F(ModelCommands, ImageDamagedAfterItsValidationIsNotActivated) {
  load_all();
  step_commands({set_mode(Mode::kStandby), validate()});
  store.banks[1].memory[500'000] ^= 4;
  step_commands({activate()});
  EXPECT_EQ(argument(EventId::kCommandNoModel, 2), static_cast<int>(gnc::ModelStatus::kBadSectionCrc));
  EXPECT_EQ(events(EventId::kModelRefused), 1);
  EXPECT_EQ(out->telemetry.bank_in_use, 0);
  step_commands({set_mode(Mode::kRun)});
  step_good();
  EXPECT_EQ(validity(), Validity::kValid) << "the old model is still in use";
}

TEST_F(ModelCommands, ActivationNamesTheImage) {
  load_all();
  step_commands({set_mode(Mode::kStandby), validate(), activate(42)});
  EXPECT_EQ(events(EventId::kCommandNoModel), 1);
  EXPECT_EQ(out->telemetry.bank_in_use, 0);
}

// Verifies TS-MDL-035, TS-FDIR-190.
TEST_F(ModelCommands, OneImageIsCheckedInACycleAndFurtherChecksAreBusy) {
  const auto size = static_cast<std::uint32_t>(other.size());
  const auto refused_as_busy = [this] {
    return out->telemetry.commands_refused_by[static_cast<std::size_t>(CommandRefusal::kBusy)];
  };
  load_all();
  step_commands({set_mode(Mode::kStandby), validate(size, 1), validate(size, 1), validate()});
  EXPECT_EQ(out->telemetry.long_task, 1);
  EXPECT_EQ(events(EventId::kModelRefused), 1) << "one check, which fails";
  EXPECT_EQ(argument(EventId::kCommandBusy, 2), 1) << "the bank";
  EXPECT_EQ(refused_as_busy(), 2U);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kLoading);
  step_commands({validate(), activate()});
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood);
  EXPECT_EQ(out->telemetry.bank_in_use, 0);
  EXPECT_EQ(refused_as_busy(), 3U);
  step_commands({activate(), activate(gnc::model_image_crc32(test_model_image().data()))});
  EXPECT_EQ(out->telemetry.bank_in_use, 1) << "not back at once";
  EXPECT_EQ(refused_as_busy(), 4U);
  step_commands({command(FunctionCode::kNoop)});
  EXPECT_EQ(out->telemetry.long_task, 0);
}

// Verifies TS-MDL-035, TS-FDIR-190.
TEST_F(ModelCommands, FrameOfTheCycleOfAnActivationIsPassedOver) {
  step_commands({set_mode(Mode::kStandby)});
  const gnc::RangeImage frame = next_frame();
  StepInputs inputs;
  inputs.frame = &frame;
  inputs.commands[0] = activate(gnc::model_image_crc32(test_model_image().data()));
  inputs.commands[1] = set_mode(Mode::kRun);
  inputs.command_count = 2;
  step(inputs);
  EXPECT_EQ(app->mode(), Mode::kRun);
  EXPECT_EQ(validity(), Validity::kPassedOver);
  EXPECT_EQ(out->telemetry.frames_passed_over, 1U);
  step_good();
  EXPECT_EQ(validity(), Validity::kValid);
  EXPECT_EQ(out->attitude.frames_since_reset, 1U);
}

TEST_F(ModelCommands, DumpReturnsTheBytesOfTheBank) {
  step_commands({dump(0, 100'000, 1024)});
  ASSERT_TRUE(out->has_dump);
  EXPECT_EQ(out->dump.bank, 0);
  EXPECT_EQ(out->dump.offset, 100'000U);
  EXPECT_EQ(out->dump.size, 1024);
  EXPECT_EQ(out->dump.time_ns, now_ns);
  const auto& memory = store.banks[0].memory;
  EXPECT_TRUE(std::equal(out->dump.bytes.begin(), out->dump.bytes.end(), memory.begin() + 100'000));
  step(StepInputs{});
  EXPECT_FALSE(out->has_dump);
}

TEST_F(ModelCommands, DumpBeyondTheBankOrASecondOneInACycleIsRefused) {
  const auto size = static_cast<std::uint32_t>(store.banks[0].memory.size());
  step_commands({dump(1, size - 4, 4), dump(0, 0, 4)});
  EXPECT_EQ(events(EventId::kCommandBusy), 1);
  EXPECT_EQ(out->dump.bank, 1);
  EXPECT_EQ(out->dump.bytes[4], 0) << "nothing is left from an earlier dump";
  step_commands(
      {dump(0, size - 3, 4), dump(2, 0, 4), dump(0, 0, 0), dump(0, 0, 1025), dump(0, 0xFFFFFFFF, 4)});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 5);
  EXPECT_FALSE(out->has_dump);
  store.banks[1] = {};
  init(store);
  step_commands({dump(1, 0, 4)});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
  store.banks[1] = {std::vector<std::uint8_t>(2), 0, true};
  init(store);
  step_commands({dump(1, 0, 4)});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
  HollowStore hollow(store);
  boot(*app, {&stopwatch, &hollow, &kTestKeys, nullptr, hal::ResetCause::kPowerOn});
  step_commands({dump(1, 0, 4), dump(0, 0, 4)});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
  EXPECT_EQ(events(EventId::kCommandAccepted), 1);
}

}  // namespace
}  // namespace tumblesight::fsw

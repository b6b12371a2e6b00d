// Loading, validating, activating and dumping models.
// Verifies TS-MDL-020, TS-MDL-030, TS-MDL-040, TS-MDL-050.
#include <algorithm>
#include <numeric>
#include <random>

#include "tests/support/app_memory.hpp"
#include "tests/support/test_models.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class ModelCommands : public AppFixture {
 protected:
  ModelCommands() : other(gnc::lasting_model_image<gnc::FixedPoint>(8)) { init_with_model(); }

  hal::CommandPacket begin(UploadBase base = UploadBase::kNothing) {
    return command(FunctionCode::kModelBegin, {static_cast<std::uint8_t>(base)});
  }
  hal::CommandPacket load(std::uint32_t offset, std::size_t size) {
    std::vector<std::uint8_t> arguments;
    append_u32(arguments, offset);
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint64_t at = std::uint64_t{offset} + i;
      arguments.push_back(at < other.size() ? other[static_cast<std::size_t>(at)] : std::uint8_t{0});
    }
    return command(FunctionCode::kModelLoad, arguments);
  }
  static std::uint32_t offset_of(std::uint32_t segment) { return segment * kSegmentBytes; }
  std::size_t bytes_of(std::uint32_t segment) const {
    return std::min<std::size_t>(kSegmentBytes, other.size() - offset_of(segment));
  }
  hal::CommandPacket segment(std::uint32_t number) { return load(offset_of(number), bytes_of(number)); }
  static std::vector<std::uint32_t> all_segments() {
    std::vector<std::uint32_t> segments(kModelSegments);
    std::iota(segments.begin(), segments.end(), 0U);
    return segments;
  }
  // The segments in which `other` differs from the model in use.
  std::vector<std::uint32_t> changed_segments() const {
    std::vector<std::uint32_t> changed;
    for (const std::uint32_t one : all_segments()) {
      const std::uint8_t* const used = store.banks[0].memory.data() + offset_of(one);
      if (!std::equal(used, used + bytes_of(one), other.begin() + offset_of(one))) changed.push_back(one);
    }
    return changed;
  }
  // Loads these segments of `other`, eight per cycle. Frames continue, one in so many cycles and one in the
  // last: inferences take most of the time of these tests.
  void load_segments(const std::vector<std::uint32_t>& segments, int cycles_per_frame = 4) {
    int cycle = 0;
    for (std::size_t i = 0; i < segments.size(); ++cycle) {
      StepInputs inputs;
      for (; inputs.command_count < config::kMaxCommandsPerStep && i < segments.size(); ++i)
        inputs.commands[static_cast<std::size_t>(inputs.command_count++)] = segment(segments[i]);
      const gnc::RangeImage frame = next_frame();
      if (cycle % cycles_per_frame == 0 || i == segments.size()) {
        sequence_number = frame.sequence_number;
        inputs.frame = &frame;
      }
      const std::uint32_t refused = out->telemetry.commands_refused;
      step(inputs);
      ASSERT_EQ(out->telemetry.commands_refused, refused);
    }
  }
  // As an upload of the whole image in order.
  void load_all(int cycles_per_frame = 4) {
    step_commands({begin()});
    load_segments(all_segments(), cycles_per_frame);
    ASSERT_EQ(out->telemetry.model_segments_missing, 0U);
  }
  // As the ground reads the bitmap.
  std::vector<std::uint32_t> missing_segments() {
    constexpr auto kBytes = static_cast<std::uint16_t>(sizeof(ModelBanksState::missing));
    step_commands({dump(static_cast<std::uint8_t>(hal::DumpedMemory::kMissingSegments), 0, kBytes)});
    EXPECT_TRUE(out->has_dump);
    std::vector<std::uint32_t> missing;
    for (std::uint32_t one = 0; one < 8U * kBytes; ++one) {
      if ((out->dump.bytes[one / 8] >> (7 - one % 8) & 1) != 0) missing.push_back(one);
    }
    EXPECT_EQ(missing.size(), out->telemetry.model_segments_missing);
    return missing;
  }
  // The bank holds `other`, bit for bit, and it runs.
  void expect_it_runs() {
    EXPECT_TRUE(std::equal(other.begin(), other.end(), store.banks[1].memory.begin()));
    const std::uint32_t refused = out->telemetry.commands_refused;
    step_commands({set_mode(Mode::kStandby), validate()});
    step_commands({activate(), set_mode(Mode::kRun)});
    EXPECT_EQ(out->telemetry.commands_refused, refused);
    EXPECT_EQ(out->telemetry.bank_in_use, 1);
    step_good();
    EXPECT_EQ(validity(), Validity::kValid);
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
    return command(FunctionCode::kMemoryDump, arguments);
  }

  std::vector<std::uint8_t> other;
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
  load_all(1);
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

TEST_F(ModelCommands, SegmentsInAnyOrderAndMoreThanOnceGiveTheSameImage) {
  std::vector<std::uint32_t> segments = all_segments();
  std::reverse(segments.begin(), segments.end());
  step_commands({begin()});
  load_segments(segments);
  expect_it_runs();

  init_with_model();
  std::mt19937 engine(3);
  std::shuffle(segments.begin(), segments.end(), engine);
  segments.insert(segments.begin() + 500, segments.begin(), segments.begin() + 200);
  step_commands({begin()});
  load_segments(segments);
  expect_it_runs();
}

// Verifies TS-MDL-070.
TEST_F(ModelCommands, LostSegmentsAreReportedSentAgainAndTheImageRuns) {
  std::vector<std::uint32_t> sent, lost;
  for (const std::uint32_t one : all_segments()) (one % 3 == 2 ? lost : sent).push_back(one);
  step_commands({begin()});
  EXPECT_EQ(missing_segments(), all_segments());
  load_segments(sent);
  EXPECT_EQ(missing_segments(), lost);
  step_commands({set_mode(Mode::kStandby), validate()});
  EXPECT_EQ(argument(EventId::kCommandIncomplete, 2), static_cast<std::int32_t>(lost.size()));
  EXPECT_EQ(events(EventId::kModelRefused), 0) << "the image was not checked";
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kLoading);
  step_commands({set_mode(Mode::kRun)});
  load_segments(lost);
  EXPECT_TRUE(missing_segments().empty());
  expect_it_runs();
}

// Verifies TS-FDIR-095. Also if flips say that a segment behind the last one is missing.
TEST_F(ModelCommands, NothingBehindTheLastSegmentIsCopied) {
  step_commands({begin(UploadBase::kBankInUse)});
  AppMemory::state(*app).banks.missing[kModelSegments / 8] |=
      static_cast<std::uint8_t>(0x80U >> kModelSegments % 8);
  AppMemory::commit(*app);
  for (int cycle = 0; cycle < 60 && out->telemetry.model_segments_missing > 0; ++cycle) {
    step({});
    ASSERT_LE(out->telemetry.model_segments_missing, kModelSegments);
  }
  EXPECT_EQ(out->telemetry.model_segments_missing, 0U);
  EXPECT_EQ(AppMemory::state(*app).banks.next_copied, kModelSegments);
}

// Verifies TS-MDL-070.
TEST_F(ModelCommands, EachMissingSegmentAloneIsNamedAndRefusesTheImage) {
  load_all();
  step_commands({set_mode(Mode::kStandby)});
  ModelBanksState& banks = AppMemory::state(*app).banks;
  for (const std::uint32_t one : all_segments()) {
    banks.missing[one / 8] = static_cast<std::uint8_t>(0x80U >> one % 8);
    banks.segments_missing = 1;
    AppMemory::commit(*app);
    ASSERT_EQ(missing_segments(), std::vector<std::uint32_t>{one});
    step_commands({validate()});
    ASSERT_EQ(argument(EventId::kCommandIncomplete, 2), 1) << one;
    step_commands({segment(one)});
    ASSERT_EQ(out->telemetry.model_segments_missing, 0U) << one;
  }
  step_commands({validate()});
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood);
}

// Verifies TS-MDL-080.
TEST_F(ModelCommands, DifferenceUploadGivesTheSameBitsAsAFullOne) {
  other = gnc::with_changed_weights(test_model_image(), {300'000, 300'001, 700'123, 800'000});
  const std::vector<std::uint32_t> changed = changed_segments();
  EXPECT_LT(changed.size(), 10U);
  std::fill(store.banks[1].memory.begin(), store.banks[1].memory.end(), std::uint8_t{0x55});
  step_commands({begin(UploadBase::kBankInUse)});
  load_segments(changed);  // while the others are being copied
  int cycles = 0;
  for (; out->telemetry.model_segments_missing > 0 && cycles < 100; ++cycles) {
    step_commands({validate()});
    step_good();
    ASSERT_EQ(validity(), Validity::kValid);
  }
  EXPECT_LT(cycles, 40);
  EXPECT_GT(cycles, 10) << "the copy is spread over cycles";
  step(StepInputs{});
  EXPECT_EQ(AppMemory::state(*app).banks.next_copied, kModelSegments) << "it ends with the image";
  expect_it_runs();
}

// Verifies TS-MDL-080.
TEST_F(ModelCommands, DifferenceUploadWithoutItsChangesIsNotTheImageThatWasMeant) {
  other = gnc::with_changed_weights(test_model_image(), {300'000});
  step_commands({set_mode(Mode::kStandby), begin(UploadBase::kBankInUse)});
  while (out->telemetry.model_segments_missing > 0) step(StepInputs{});
  step_commands({validate()});
  EXPECT_EQ(argument(EventId::kCommandNoModel, 2), static_cast<int>(gnc::ModelStatus::kBadHeaderCrc));
  step_commands({set_mode(Mode::kRun)});
  load_segments(changed_segments());
  expect_it_runs();
}

// Verifies TS-MDL-080.
TEST_F(ModelCommands, UploadGoesOnAfterAResetFromWhatTheBankHolds) {
  step_commands({begin()});
  std::vector<std::uint32_t> segments = all_segments();
  load_segments({segments.begin(), segments.begin() + 800});
  init(store);
  step_commands({begin(UploadBase::kSameBank)});
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kLoading);
  load_segments({segments.begin() + 800, segments.end()});
  expect_it_runs();
}

// Verifies TS-MDL-080.
TEST_F(ModelCommands, CopyThatCannotBeWrittenMakesTheImageVoid) {
  step_commands({begin(UploadBase::kBankInUse)});
  const auto missing = static_cast<std::int32_t>(out->telemetry.model_segments_missing);
  store.banks[1].dead = true;
  step(StepInputs{});
  EXPECT_EQ(argument(EventId::kUploadFailed, 0), 1);
  EXPECT_EQ(argument(EventId::kUploadFailed, 1), missing);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kEmpty);
  EXPECT_EQ(out->telemetry.model_segments_missing, 0U);
  step(StepInputs{});
  EXPECT_EQ(events(EventId::kUploadFailed), 0);
}

// Verifies TS-MDL-080.
TEST_F(ModelCommands, CopyNeedsAModelInUse) {
  step_commands({begin(UploadBase::kBankInUse)});
  const std::uint32_t missing = out->telemetry.model_segments_missing;
  store.banks[0].memory[100'000] ^= 1;
  store.banks[0].writable = false;
  AppMemory::state(*app).banks.descriptor[0].set(BankStatus::kEmpty);
  AppMemory::commit(*app);
  step(StepInputs{});
  EXPECT_EQ(out->telemetry.model_segments_missing, missing) << "the copy waits";
  step_commands({begin(UploadBase::kBankInUse)});
  EXPECT_EQ(events(EventId::kCommandNoModel), 1);
  step_commands({begin()});
  EXPECT_EQ(events(EventId::kCommandAccepted), 1);
}

TEST_F(ModelCommands, OnlyWholeSegmentsOfAnImageThatWasBegunAreTaken) {
  step_commands({segment(0)});
  EXPECT_EQ(events(EventId::kCommandNoModel), 1) << "nothing was begun";
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood);
  step_commands({begin(static_cast<UploadBase>(3))});
  EXPECT_EQ(argument(EventId::kCommandWrongArgument, 2), 3);
  const std::uint32_t last = kModelSegments - 1;
  step_commands({begin(), load(512, 1024), load(0, 1023), load(offset_of(last), bytes_of(last) + 1),
                 load(offset_of(last + 1), 1), load(0xFFFFFC00, 1024)});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 5);
  EXPECT_EQ(argument(EventId::kCommandWrongArgument, 2), 512);
  EXPECT_EQ(out->telemetry.model_segments_missing, kModelSegments);
  step_commands({segment(last), segment(last)});
  EXPECT_EQ(out->telemetry.model_segments_missing, kModelSegments - 1);
  step_commands({begin()});
  EXPECT_EQ(out->telemetry.model_segments_missing, kModelSegments) << "a new image";
}

TEST_F(ModelCommands, RoomBehindTheImageIsNotLoaded) {
  store.banks[1].memory.resize(store.banks[1].memory.size() + 8 * kSegmentBytes);
  init(store);
  step_commands({begin(), load(offset_of(kModelSegments), kSegmentBytes)});
  EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
  EXPECT_EQ(out->telemetry.model_segments_missing, kModelSegments);
}

TEST_F(ModelCommands, BankThatTheImageDoesNotFitIntoIsNotLoaded) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{2}, other.size() - 1}) {
    store.banks[1] = {std::vector<std::uint8_t>(size), 0, true};
    init(store);
    step_commands({begin(), segment(0)});
    EXPECT_EQ(events(EventId::kCommandWrongArgument), 1);
    EXPECT_EQ(events(EventId::kCommandNoModel), 1);
  }
  store.banks[1].memory.resize(other.size());
  init(store);
  step_commands({begin(), segment(0)});
  EXPECT_EQ(events(EventId::kCommandAccepted), 2);
}

TEST_F(ModelCommands, ValidatedImageIsNeitherContinuedNorValidatedAgain) {
  load_all();
  step_commands({set_mode(Mode::kStandby), validate(), validate(), segment(0)});
  EXPECT_EQ(events(EventId::kCommandNoModel), 2);
  EXPECT_EQ(out->telemetry.bank_status[1], BankStatus::kGood);
}

TEST_F(ModelCommands, ReadOnlyBankIsNotLoaded) {
  store.banks[1].writable = false;
  init(store);
  step_commands({begin()});
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
  EXPECT_EQ(out->dump.memory, hal::DumpedMemory::kBank0);
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
  EXPECT_EQ(out->dump.memory, hal::DumpedMemory::kBank1);
  EXPECT_EQ(out->dump.bytes[4], 0) << "nothing is left from an earlier dump";
  step_commands(
      {dump(0, size - 3, 4), dump(5, 0, 4), dump(0, 0, 0), dump(0, 0, 1025), dump(0, 0xFFFFFFFF, 4)});
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

#include "fsw/app/cycle.hpp"

#include "hal/fake/fake_lidar.hpp"
#include "hal/fake/fake_link.hpp"
#include "hal/fake/fake_platform.hpp"
#include "tests/support/app_memory.hpp"
#include "tests/support/trials.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

class Cycle : public AppFixture {
 protected:
  Cycle() : workspace(std::make_unique<CycleWorkspace>()) { init_with_model(); }
  void run(std::uint32_t slips = 0) {
    now_ns = next_time_ns();
    run_cycle(*app, {lidar, link, watchdog, stopwatch, &navigation}, now_ns, slips, *workspace);
  }
  Validity last_validity() const { return link.attitudes.back().validity; }

  std::unique_ptr<CycleWorkspace> workspace;
  hal::fake::FakeLidar lidar;
  hal::fake::FakeLink link;
  hal::fake::FakeWatchdog watchdog;
  hal::fake::FakeNavigation navigation;
};

// Verifies TS-TLM-010.
TEST_F(Cycle, PublishesOneAttitudeOneTelemetryAndEveryEvent) {
  lidar.add(next_frame());
  link.add(command(FunctionCode::kNoop));
  run();
  ASSERT_EQ(link.attitudes.size(), 1U);
  EXPECT_EQ(last_validity(), Validity::kValid);
  EXPECT_EQ(link.telemetry.size(), 1U);
  ASSERT_EQ(link.events.size(), 2U);
  EXPECT_EQ(link.events[0].id, EventId::kModelActivated);
  EXPECT_EQ(link.events[1].id, EventId::kCommandAccepted);
}

// Verifies TS-FDIR-160.
TEST_F(Cycle, WatchdogIsKickedAfterAllDutiesAreDone) {
  run();
  EXPECT_EQ(watchdog.kicks, 1);
  run();
  EXPECT_EQ(watchdog.kicks, 2);
}

// Verifies TS-FDIR-160.
TEST_F(Cycle, WatchdogIsNotKickedIfDutiesAreNotDone) {
  app = std::make_unique<AttitudeInitApp>();  // never booted
  run();
  EXPECT_EQ(watchdog.kicks, 0);
  EXPECT_EQ(link.telemetry.back().mode, Mode::kSafe) << "telemetry continues";
}

TEST_F(Cycle, MissedReleasesAreCountedAndReported) {
  run(3);
  EXPECT_EQ(link.telemetry.back().cycle_slips, 3U);
  EXPECT_EQ(link.events.back().id, EventId::kCycleSlipped);
  EXPECT_TRUE(hal::depends_on_wall_clock(link.events.back().id));
}

// A link and a sensor that take their time.
class SlowLink final : public hal::Link {
 public:
  explicit SlowLink(hal::fake::FakeStopwatch& stopwatch) : stopwatch_(stopwatch) {}
  bool receive(hal::CommandPacket&) override { return false; }
  void publish(const hal::AttitudeReport&) override { stopwatch_.time_ns += 700'000'000; }
  void publish(const hal::Telemetry& sample) override {
    stopwatch_.time_ns += 1'000'000;
    telemetry = sample;
  }
  void publish(const hal::Event&) override {
    stopwatch_.time_ns += 10'000;
    ++events;
  }
  void publish(const hal::MemoryDump&) override {}
  hal::Telemetry telemetry;
  std::uint32_t events = 0;

 private:
  hal::fake::FakeStopwatch& stopwatch_;
};
class SlowLidar final : public hal::Lidar {
 public:
  explicit SlowLidar(hal::fake::FakeStopwatch& stopwatch) : stopwatch_(stopwatch) {}
  hal::LidarStatus receive(gnc::RangeImage&) override {
    stopwatch_.time_ns += 30'000'000;
    return hal::LidarStatus::kNoFrame;
  }

 private:
  hal::fake::FakeStopwatch& stopwatch_;
};

// Verifies TS-TLM-050.
TEST_F(Cycle, IsMeasuredFromBeforeItReceivesUntilAllIsPublished) {
  SlowLink slow_link(stopwatch);
  SlowLidar slow_lidar(stopwatch);
  const auto run_slowly = [&] {
    now_ns = next_time_ns();
    run_cycle(*app, {slow_lidar, slow_link, watchdog, stopwatch}, now_ns, 0, *workspace);
    return slow_link.telemetry;
  };
  EXPECT_EQ(run_slowly().cycle_us, 0U) << "there is no cycle before";
  const std::uint32_t events = slow_link.events;
  ASSERT_GT(events, 0U);
  const hal::Telemetry second = run_slowly();
  EXPECT_EQ(second.cycle_us, 731'000U + 10 * events);
  EXPECT_EQ(second.cycles_by_time[6], 1U) << "300 ms to 1 s";
  stopwatch.tick_ns = 200'000'000;
  run_slowly();
  const hal::Telemetry last = run_slowly();
  EXPECT_GE(last.cycle_us, 931'000U);
  EXPECT_EQ(last.cycle_max_us, last.cycle_us);
}

// Before the vote: the time that it takes counts.
TEST_F(Cycle, BeginsBeforeTheVote) {
  class Reading final : public hal::Stopwatch {
   public:
    explicit Reading(const AttitudeInitApp& app) : app_(app) {}
    std::uint64_t now_ns() override {
      if (first_mode_ == Mode::kBoot) first_mode_ = app_.mode();
      return 0;
    }
    Mode first_mode() const { return first_mode_; }

   private:
    const AttitudeInitApp& app_;
    Mode first_mode_ = Mode::kBoot;
  };
  Reading reading(*app);
  AppMemory::state(*app).mode = Mode::kSafe;  // in one copy: the vote corrects it
  now_ns = next_time_ns();
  run_cycle(*app, {lidar, link, watchdog, reading}, now_ns, 0, *workspace);
  EXPECT_EQ(reading.first_mode(), Mode::kSafe);
  EXPECT_EQ(app->mode(), Mode::kRun);
}

TEST_F(Cycle, PublishesADumpInTheCycleThatAskedForIt) {
  link.add(command(FunctionCode::kMemoryDump, {0, 0, 0, 0, 0, 0, 4}));
  run();
  ASSERT_EQ(link.dumps.size(), 1U);
  EXPECT_EQ(link.dumps[0].bytes[0], 'T');
  run();
  EXPECT_EQ(link.dumps.size(), 1U);
}

TEST_F(Cycle, NothingIsLeftFromTheLastCycle) {
  lidar.add(next_frame());
  link.add(command(FunctionCode::kNoop));
  run();
  run();
  EXPECT_EQ(last_validity(), Validity::kNoFrame);
  EXPECT_EQ(link.telemetry.back().commands_accepted, 1U);
  EXPECT_EQ(link.telemetry.back().frames_used, 1U);
}

TEST_F(Cycle, CommandsBeyondTheLimitWaitForTheNextCycle) {
  for (int i = 0; i < config::kMaxCommandsPerStep + 3; ++i) link.add(command(FunctionCode::kNoop));
  run();
  EXPECT_EQ(link.waiting(), 3U);
  EXPECT_EQ(link.telemetry.back().commands_accepted, static_cast<unsigned>(config::kMaxCommandsPerStep));
  run();
  EXPECT_EQ(link.telemetry.back().commands_accepted, static_cast<unsigned>(config::kMaxCommandsPerStep + 3));
}

// A frame is chosen before the step, by a state that is voted already: a flip of any bit of one copy of what
// it is judged by, that is the last frames and the parameters, is corrected first, and counted once.
TEST_F(Cycle, AFlippedBitDoesNotChangeTheChoiceOfTheFrame) {
  const auto choose = [this](Region (*region)(AppState&), std::size_t bit) {
    lidar.add(good_frame(sequence_number + 1, next_time_ns() - 1'000'000'000, sequence_number));
    lidar.add(good_frame(sequence_number + 2, next_time_ns(), sequence_number + 1));
    sequence_number += 2;
    region(AppMemory::state(*app)).flip(bit);
    const hal::Telemetry before = workspace->outputs.telemetry;
    run();
    const hal::Telemetry& after = workspace->outputs.telemetry;
    return link.attitudes.back().sequence_number == sequence_number &&
           after.frames_superseded == before.frames_superseded + 1 &&
           after.memory_corrections == before.memory_corrections + 1;
  };
  const auto gate = [](AppState& state) { return AppMemory::region_of(state.tracking.gate); };
  const auto history = [](AppState& state) { return AppMemory::region_of(state.tracking.history); };
  const auto table = [](AppState& state) { return AppMemory::region_of(state.table); };
  for (Region (*const region)(AppState&) :
       {static_cast<Region (*)(AppState&)>(gate), static_cast<Region (*)(AppState&)>(history),
        static_cast<Region (*)(AppState&)>(table)}) {
    init_with_model();
    run();
    const std::size_t bits = 8 * region(AppMemory::state(*app)).size;
    const std::size_t apart = bits / 200 + 1;
    for (std::size_t bit = 0; bit < bits; bit += apart)
      ASSERT_TRUE(choose(region, bit)) << bit << " of " << bits;
  }
}

// The driver's frames are judged by the sequence number alone here: one flip makes the next one a duplicate.
TEST_F(Cycle, AFlippedSequenceNumberMakesNoFrameADuplicate) {
  lidar.add(next_frame());
  run();
  const gnc::RangeImage next = good_frame(workspace->frames[0].sequence_number ^ 1U, next_time_ns(), 7);
  lidar.add(next);
  auto* const gate = AppMemory::region_of(AppMemory::state(*app).tracking.gate).data;
  gate[sizeof(std::int64_t)] ^= 1U;
  run();
  EXPECT_EQ(link.telemetry.back().frames_duplicate, 0U);
  EXPECT_EQ(link.telemetry.back().frames_used, 2U);
  EXPECT_EQ(link.telemetry.back().memory_corrections, 1U);
}

// Verifies TS-LID-052.
TEST_F(Cycle, NewestFrameOfABacklogIsUsedAndTheOthersAreCounted) {
  now_ns += 10 * config::kFramePeriod_ns;
  const std::int64_t cycle_ns = next_time_ns();
  lidar.add(good_frame(1, cycle_ns - 2 * config::kFramePeriod_ns, 1));  // stale
  lidar.add(good_frame(2, cycle_ns - 2'000'000'000, 2));
  lidar.add(good_frame(4, cycle_ns - 500'000'000, 4));
  lidar.add(good_frame(4, cycle_ns - 500'000'000, 4));    // twice
  lidar.add(good_frame(3, cycle_ns - 1'000'000'000, 3));  // out of order
  lidar.add(good_frame(5, cycle_ns + kFutureTolerance_ns + 1, 5));
  run();
  EXPECT_EQ(lidar.waiting(), 0U);
  EXPECT_EQ(last_validity(), Validity::kValid);
  EXPECT_EQ(link.attitudes.back().sequence_number, 4U);
  const hal::Telemetry& counters = link.telemetry.back();
  EXPECT_EQ(counters.frames_used, 1U);
  EXPECT_EQ(counters.frames_superseded, 2U);
  EXPECT_EQ(counters.frames_duplicate, 1U);
  EXPECT_EQ(counters.frames_stale, 2U) << "too old and in the future";
  EXPECT_EQ(counters.frames_refused, 3U);
}

// Verifies TS-LID-052.
TEST_F(Cycle, NewestFrameOfABacklogIsNotUsedIfItRepeatsTheOneBefore) {
  std::uint32_t number = 0;
  for (unsigned cycle = 0; cycle < 20; ++cycle) {
    const std::int64_t exposure_ns = next_time_ns() - 1'400'000'000;
    lidar.add(good_frame(number++, exposure_ns, cycle));
    lidar.add(good_frame(number++, next_time_ns() - 50'000'000, cycle));
    run();
    EXPECT_EQ(last_validity(), Validity::kValid);
    EXPECT_EQ(link.attitudes.back().exposure_time_ns, exposure_ns) << "that of the content";
  }
  const hal::Telemetry& counters = link.telemetry.back();
  EXPECT_EQ(counters.frames_repeated, 20U);
  EXPECT_EQ(counters.frames_superseded, 0U);
  EXPECT_NE(counters.faults_persisting & bit_of(Fault::kFrameFrozen), 0U);
}

// Verifies TS-LID-052, TS-FDIR-170. A driver that hands out one of its used buffers again, behind the fresh
// frame or before it, and in both cases under the next number and time.
TEST_F(Cycle, UsedBufferUnderANewNumberDoesNotTakeThePlaceOfTheFreshFrame) {
  constexpr unsigned kBefore = 10;
  for (unsigned age = 1; age <= gnc::FrameHistory::kFrames; ++age) {
    for (const bool fresh_is_first : {true, false}) {
      init_with_model();
      std::uint32_t number = 0;
      const unsigned cycles = kBefore + (TUMBLESIGHT_FEW_TRIALS ? 6 : 20);
      for (unsigned cycle = 0; cycle < cycles; ++cycle) {
        const std::int64_t first_ns = next_time_ns() - 1'400'000'000, second_ns = next_time_ns() - 50'000'000;
        const bool with_old = cycle >= kBefore;
        if (with_old && !fresh_is_first) lidar.add(good_frame(number++, first_ns, cycle - age));
        const std::int64_t fresh_ns = fresh_is_first ? first_ns : second_ns;
        lidar.add(good_frame(number++, fresh_ns, cycle));
        if (with_old && fresh_is_first) lidar.add(good_frame(number++, second_ns, cycle - age));
        run();
        ASSERT_EQ(last_validity(), Validity::kValid) << age << ' ' << cycle;
        EXPECT_EQ(link.attitudes.back().exposure_time_ns, fresh_ns);
      }
      const hal::Telemetry& counters = link.telemetry.back();
      EXPECT_EQ(counters.frames_used, cycles);
      EXPECT_EQ(counters.frames_repeated, cycles - kBefore);
      EXPECT_EQ(counters.frames_superseded, 0U);
      EXPECT_NE(counters.faults_persisting & bit_of(Fault::kFrameFrozen), 0U) << "the ground is told";
    }
  }
}

// Verifies TS-LID-052. Rows that are stuck, at the top of every frame, do not make it a repetition, whether
// they are in the range gate or not. Of the deliveries of a cycle only the first are compared in full.
TEST_F(Cycle, FramesWithStuckFirstRowsAreUsed) {
  for (const int stuck_counts : {640, 9000, 0xFFFF}) {
    const auto stuck_frame = [&](std::uint32_t number, std::int64_t exposure_ns, unsigned noise) {
      gnc::RangeImage frame = good_frame(number, exposure_ns, noise);
      std::fill_n(frame.ranges.begin(), 7 * frame.rays, static_cast<std::uint16_t>(stuck_counts));
      return frame;
    };
    for (const std::uint32_t deliveries : {1U, 2U, 5U}) {
      SCOPED_TRACE(std::to_string(stuck_counts) + ' ' + std::to_string(deliveries));
      init_with_model();
      std::uint32_t number = 0;
      for (std::uint32_t cycle = 0; cycle < 12; ++cycle) {
        for (std::uint32_t i = deliveries; i-- > 0; ++number)
          lidar.add(stuck_frame(number, next_time_ns() - 200'000'000 * i, number));
        run();
        EXPECT_EQ(link.telemetry.back().frames_used, cycle + 1);
        EXPECT_EQ(link.attitudes.back().sequence_number, number - 1) << "the newest";
      }
      EXPECT_EQ(link.telemetry.back().frames_repeated, 0U);
      const unsigned last_noise = number - 1;
      for (std::uint32_t i = deliveries; i-- > 0; ++number)
        lidar.add(stuck_frame(number, next_time_ns() - 200'000'000 * i, last_noise));
      run();
      EXPECT_EQ(link.telemetry.back().frames_repeated, deliveries) << "repetitions are still seen";
    }
  }
}

// Verifies TS-LID-052, TS-FDIR-170. A driver that delivers the fresh frame again, with some of its ranges
// changed: the content keeps its own time.
TEST_F(Cycle, FreshFrameIsNotReplacedByItsCopyWithStrayReturns) {
  std::uint32_t number = 0;
  for (unsigned cycle = 0; cycle < 20; ++cycle) {
    const std::int64_t fresh_ns = next_time_ns() - 1'400'000'000;
    const gnc::RangeImage fresh = good_frame(number++, fresh_ns, cycle);
    gnc::RangeImage copy = fresh;
    copy.sequence_number = number++;
    copy.exposure_time_ns = next_time_ns() - 50'000'000;
    for (std::size_t i = 0; i < 100; ++i) copy.ranges[i] = static_cast<std::uint16_t>(3'000 + 37 * i + cycle);
    lidar.add(fresh);
    lidar.add(copy);
    run();
    EXPECT_EQ(link.attitudes.back().exposure_time_ns, fresh_ns);
  }
  EXPECT_EQ(link.telemetry.back().frames_repeated, 20U);
}

// Verifies TS-LID-052. A fast sensor that hangs after some frames of the cycle.
TEST_F(Cycle, CopiesAreSeenAmongManyFrames) {
  constexpr std::uint32_t kFrames = 20, kFresh = 9;
  for (std::uint32_t cycle = 0; cycle < 5; ++cycle) {
    std::uint32_t used = 0;
    for (std::uint32_t i = 0; i < kFrames; ++i) {
      const std::uint32_t number = cycle * kFrames + i, content = cycle * kFrames + std::min(i, kFresh - 1);
      if (i < kFresh) used = number;
      lidar.add(good_frame(number, next_time_ns() - 100'000'000 * (kFrames - 1 - i), content));
    }
    run();
    EXPECT_EQ(link.attitudes.back().sequence_number, used) << "the last fresh one";
  }
  EXPECT_EQ(link.telemetry.back().frames_repeated, 5 * (kFrames - kFresh));
}

// Verifies TS-LID-052, TS-FDIR-170. A used buffer whose time is that of the cycle, before a fresh frame with
// its own.
TEST_F(Cycle, UsedBufferDoesNotSupersedeAFreshFrameOfAnEarlierTime) {
  for (unsigned cycle = 0; cycle < 10; ++cycle) {
    if (cycle > 0) lidar.add(good_frame(2 * cycle, next_time_ns(), cycle - 1));
    lidar.add(good_frame(2 * cycle + 1, next_time_ns() - 50'000'000, cycle));
    run();
    EXPECT_EQ(last_validity(), Validity::kValid);
    EXPECT_EQ(link.attitudes.back().sequence_number, 2 * cycle + 1);
  }
  EXPECT_EQ(link.telemetry.back().frames_repeated, 9U);
}

// What a cycle in STANDBY has received was not used.
TEST_F(Cycle, FrameIsNotComparedWithThoseOfTheCycleBefore) {
  link.add(set_mode(Mode::kStandby));
  for (const std::uint32_t number : {1U, 2U})
    lidar.add(good_frame(number, next_time_ns() - 1'000'000'000 + 400'000'000 * number, number));
  run();
  link.add(set_mode(Mode::kRun));
  lidar.add(good_frame(3, next_time_ns(), 2));
  run();
  EXPECT_EQ(last_validity(), Validity::kValid);
  EXPECT_EQ(link.telemetry.back().frames_repeated, 0U);
}

// Verifies TS-LID-052.
TEST_F(Cycle, NewestFrameWithGoodContentIsUsed) {
  const std::int64_t cycle_ns = next_time_ns();
  lidar.add(good_frame(1, cycle_ns - 900'000'000, 1));
  lidar.add(good_frame(2, cycle_ns - 800'000'000, 2));
  for (std::uint32_t number = 3; number < 6; ++number) {
    gnc::RangeImage bad = good_frame(number, cycle_ns - 800'000'000 + 100'000'000 * (number - 2), number);
    if (number == 3) bad.ranges.fill(0);
    if (number == 4) bad.rays = 200;
    if (number == 5) bad.ranges.fill(6400);
    lidar.add(bad);
  }
  run();
  EXPECT_EQ(last_validity(), Validity::kValid);
  EXPECT_EQ(link.attitudes.back().sequence_number, 2U);
  const hal::Telemetry& counters = link.telemetry.back();
  EXPECT_EQ(counters.frames_used, 1U);
  EXPECT_EQ(counters.frames_superseded, 1U);
  EXPECT_EQ(counters.frames_bad, 3U);
  EXPECT_EQ(counters.frames_refused, 3U);
  std::vector<std::array<std::int32_t, 3>> reasons;
  for (const hal::Event& event : link.events)
    if (event.id == EventId::kFrameBad) reasons.push_back(event.arguments);
  using gnc::FrameStatus;
  const std::vector<std::array<std::int32_t, 3>> expected{
      {3, static_cast<std::int32_t>(FrameStatus::kEmpty), 32},
      {4, static_cast<std::int32_t>(FrameStatus::kBadRayCount), 200},
      {5, static_cast<std::int32_t>(FrameStatus::kFlat), 32}};
  EXPECT_EQ(reasons, expected);
}

// Verifies TS-LID-052. Bad content takes long to see, and the cycle's time is bounded.
TEST_F(Cycle, AfterThreeBadFramesTheRestOfTheCyclesFramesCountsAsBad) {
  const std::int64_t cycle_ns = next_time_ns();
  for (std::uint32_t number = 1; number <= 6; ++number) {
    gnc::RangeImage frame = good_frame(number, cycle_ns - 100'000'000 * (7 - number), number);
    if (number >= 2 && number <= 4) frame.ranges.fill(0);
    lidar.add(frame);
  }
  run();
  EXPECT_EQ(link.attitudes.back().sequence_number, 1U);
  EXPECT_EQ(link.telemetry.back().frames_bad, 5U);
  lidar.add(good_frame(7, next_time_ns(), 7));
  run();
  EXPECT_EQ(link.attitudes.back().sequence_number, 7U) << "the next cycle looks again";
}

TEST_F(Cycle, LargestBacklogIsReceivedInOneCycle) {
  for (int i = 0; i < config::kMaxDeliveriesPerCycle + 2; ++i) lidar.add_wrong_size();
  run();
  EXPECT_EQ(lidar.waiting(), 0U);
  EXPECT_EQ(link.telemetry.back().frames_overflowed, 2U);
  EXPECT_EQ(link.telemetry.back().frames_bad, static_cast<unsigned>(config::kMaxDeliveriesPerCycle));
  EXPECT_EQ(app->mode(), Mode::kRun);
}

// Verifies TS-LID-052.
TEST_F(Cycle, SensorsFasterThanTheCycleGiveAnAttitudeInEveryCycle) {
  for (const std::int64_t period_ns :
       {std::int64_t{33'333'333}, std::int64_t{80'000'000}, std::int64_t{200'000'000},
        std::int64_t{1'000'000'000}, std::int64_t{1'351'351'351}, std::int64_t{2'700'000'001}}) {
    init_with_model();
    std::uint32_t number = 0;
    std::int64_t exposure_ns = now_ns + 123'456'789;
    int attitudes = 0;
    constexpr int kCycles = trials(120);
    for (int cycle = 0; cycle < kCycles; ++cycle) {
      for (; exposure_ns <= next_time_ns(); exposure_ns += period_ns, ++number)
        lidar.add(good_frame(number, exposure_ns, 7 * number + 1));
      run();
      EXPECT_EQ(lidar.waiting(), 0U);
      attitudes += last_validity() == Validity::kValid ? 1 : 0;
    }
    EXPECT_GE(attitudes, kCycles - 1) << period_ns;
    const hal::Telemetry& counters = link.telemetry.back();
    EXPECT_EQ(counters.frames_used + counters.frames_superseded + counters.frames_overflowed, number)
        << "every frame is accounted for";
    EXPECT_EQ(counters.frames_overflowed > 0, period_ns < config::kFramePeriod_ns / 32);
    EXPECT_EQ(counters.sequence_gaps, 0U);
    EXPECT_LE(counters.estimator_resets, 1U);
    EXPECT_EQ(link.attitudes.back().frames_since_reset, static_cast<unsigned>(attitudes));
  }
}

TEST_F(Cycle, OverflowIsCountedWithoutAGoodFrameTooAndInRunOnly) {
  class Overflowing final : public hal::Lidar {
   public:
    hal::LidarStatus receive(gnc::RangeImage&) override { return hal::LidarStatus::kNoFrame; }
    std::uint32_t take_dropped() override { return 3; }
  } overflowing;
  const auto overflowed = [&](std::int64_t time_ns) {
    now_ns = time_ns;
    run_cycle(*app, {overflowing, link, watchdog, stopwatch}, now_ns, 0, *workspace);
    return link.telemetry.back().frames_overflowed;
  };
  EXPECT_EQ(overflowed(next_time_ns()), 3U);
  EXPECT_EQ(overflowed(now_ns), 6U) << "the time does not advance";
  link.add(set_mode(Mode::kStandby));
  EXPECT_EQ(overflowed(next_time_ns()), 6U);
}

TEST_F(Cycle, SensorSlowerThanTheCycleKeepsItsTrack) {
  std::uint32_t number = 0;
  std::int64_t exposure_ns = now_ns;
  for (int cycle = 0; cycle < 40; ++cycle) {
    for (; exposure_ns <= next_time_ns(); exposure_ns += 5'400'000'000, ++number)
      lidar.add(good_frame(number, exposure_ns, 7 * number + 1));
    run();
  }
  EXPECT_EQ(link.telemetry.back().frames_used, number);
  EXPECT_EQ(link.telemetry.back().frames_refused, 0U);
  EXPECT_GE(link.attitudes.back().frames_since_reset + link.attitudes[38].frames_since_reset, number);
}

// Verifies TS-LID-054.
TEST_F(Cycle, SensorClockOneNanosecondAheadIsUsed) {
  for (std::uint32_t number = 1; number <= 30; ++number) {
    lidar.add(good_frame(number, next_time_ns() + 1, number));
    run();
    EXPECT_EQ(last_validity(), Validity::kValid);
  }
  EXPECT_EQ(link.telemetry.back().frames_used, 30U);
}

TEST_F(Cycle, ChasersAttitudeIsAskedForAtTheExposureAndAtTheCycle) {
  std::vector<std::int64_t> asked;
  navigation.attitude = [&](std::int64_t time_ns) {
    asked.push_back(time_ns);
    return gnc::ChaserAttitude{time_ns, gnc::kIdentityQ30, true};
  };
  run();
  EXPECT_TRUE(asked.empty()) << "no frame";
  gnc::RangeImage frame = next_frame();
  frame.exposure_time_ns -= 1'000'000;
  lidar.add(frame);
  run();
  EXPECT_EQ(asked, (std::vector<std::int64_t>{now_ns - 1'000'000, now_ns}));
  EXPECT_EQ(link.attitudes.back().doubts & hal::kDoubtChaserUnknown, 0);
  navigation.attitude = nullptr;
  for (unsigned i = 0; i < 4; ++i) {
    lidar.add(good_frame(200 + i, next_time_ns(), 9 + i));
    run();
    EXPECT_EQ(last_validity(), i < 2 ? Validity::kFrameRefused : Validity::kValid);
  }
  EXPECT_NE(link.attitudes.back().doubts & hal::kDoubtChaserUnknown, 0);
}

TEST_F(Cycle, AMotionNowThatIsNotInTheLrfOfNowIsMarked) {
  // The navigation knows the past up to the exposure only.
  std::int64_t known_ns = 0;
  navigation.attitude = [&](std::int64_t time_ns) {
    return gnc::ChaserAttitude{std::min(time_ns, known_ns), gnc::kIdentityQ30, true};
  };
  for (const bool late : {true, false, true}) {
    gnc::RangeImage frame = next_frame();
    sequence_number = frame.sequence_number;
    frame.exposure_time_ns -= 1'350'000'000;
    known_ns = late ? frame.exposure_time_ns : next_time_ns();
    lidar.add(frame);
    run();
    EXPECT_EQ(last_validity(), Validity::kValid);
    EXPECT_EQ(link.attitudes.back().doubts & ~hal::kDoubtRateAmbiguous,
              late ? hal::kDoubtChaserNowUnknown : 0);
  }
}

TEST_F(Cycle, WorksWithoutNavigation) {
  now_ns = next_time_ns();
  lidar.add(good_frame(1, now_ns, 1));
  run_cycle(*app, {lidar, link, watchdog, stopwatch}, now_ns, 0, *workspace);
  EXPECT_EQ(last_validity(), Validity::kValid);
  EXPECT_NE(link.attitudes.back().doubts & hal::kDoubtChaserUnknown, 0);
}

TEST_F(Cycle, WrongSizeBesideAGoodFrameIsCountedAndTheFrameUsed) {
  lidar.add_wrong_size();
  lidar.add(next_frame());
  run();
  EXPECT_EQ(last_validity(), Validity::kValid);
  EXPECT_EQ(link.telemetry.back().frames_bad, 1U);
  lidar.add_wrong_size();
  run();
  EXPECT_EQ(last_validity(), Validity::kFrameRefused);
  EXPECT_EQ(link.telemetry.back().frames_bad, 2U);
}

}  // namespace
}  // namespace tumblesight::fsw

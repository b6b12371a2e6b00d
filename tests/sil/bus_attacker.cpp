// A program that joins the bus of a run without being asked, in every partition, and forges samples of one
// topic until it is ended, at most half a minute. Arguments: DDS domain, what to forge, "observed" or
// "guessed" run id, "observed" or "guessed" step, and the step of the run from which on it has a writer
// (0: from the start). It writes "ready" to the standard output when it listens.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <optional>
#include <string>
#include <type_traits>

#include "hal/dds/idl/development_key.hpp"
#include "hal/dds/idl/icd_hash.hpp"
#include "hal/dds/idl/step_content.hpp"
#include "hal/dds/idl/topics.hpp"
#include "sim/host/end_with_starter.hpp"
#include "sim/operations/signed_telecommand.hpp"

namespace {

using namespace tumblesight;
using namespace tumblesight::hal::dds;

constexpr std::uint32_t kGuess = 1;
constexpr const char* kEveryPartition = "*";

struct Plan {
  std::uint32_t domain = 0;
  std::string target;
  bool run_id_observed = false;
  bool k_observed = false;
  std::uint32_t begin_k = 0;
};

// Everything that is on the bus, kept as it was seen last.
class Observer {
 public:
  bool open(const Domain& domain) {
    return hellos_.open(domain) == 0 && frames_.open(domain) == 0 && steps_.open(domain) == 0 &&
           attitudes_.open(domain) == 0 && telemetries_.open(domain) == 0;
  }
  void look() {
    HelloSample hello;
    while (hellos_.take(hello)) {
      if (hello.run_id != 0) run_id = hello.run_id;
      subject = hello;
    }
    while (frames_.take(frame)) run_id = frame.run_id;
    while (attitudes_.take(attitude)) {
    }
    while (telemetries_.take(telemetry)) {
    }
    StepSample seen;
    while (steps_.take(seen)) step = seen;
  }

  std::uint32_t run_id = kGuess;
  HelloSample subject{};  // of any program: target and model image
  LidarFrameSample frame{};
  std::optional<StepSample> step;
  AttitudeSample attitude{};
  TelemetrySample telemetry{};

 private:
  Reader<HelloSample> hellos_;
  Reader<LidarFrameSample> frames_;
  Reader<StepSample> steps_;
  Reader<AttitudeSample> attitudes_;
  Reader<TelemetrySample> telemetries_;
};

class Forger {
 public:
  Forger(const Plan& plan, const Domain& domain, const Observer& seen)
      : plan_(plan), domain_(domain), seen_(seen), ground_(kDevelopmentKey) {}

  void forge() {
    run_id_ = plan_.run_id_observed ? seen_.run_id : kGuess;
    // Both the step that is being answered and the one that comes next.
    const std::uint32_t latest = seen_.step ? seen_.step->k : 0;
    for (std::uint32_t k : {latest, latest + 1}) {
      k_ = plan_.k_observed ? k : ++guess_ % 16;
      write_target();
    }
  }

 private:
  void write_target() {
    const std::string& target = plan_.target;
    if (target == "hello-of-simulator") forge_hello(Role::kSimulator);
    if (target == "hello-of-flight") forge_hello(Role::kFlight);
    if (target == "frame") forge_frame();
    if (target == "navigation") forge_navigation();
    if (target == "command") forge_command();
    if (target == "step") forge_step();
    if (target == "attitude") forge_attitude();
    if (target == "telemetry") forge_telemetry();
    if (target == "event") forge_event();
    if (target == "dump") forge_dump();
    if (target == "step-done") forge_step_done();
    if (target == "truth") forge_truth();
  }

  template <class Sample>
  void write(Writer<Sample>& writer, Sample& sample) {
    if (writer.entity() <= 0 && writer.open(domain_) != 0) std::exit(3);
    sample.run_id = run_id_;
    if constexpr (!std::is_same_v<Sample, HelloSample>) sample.k = k_;
    (void)writer.write(sample);
  }

  void forge_hello(Role role) {
    HelloSample hello = seen_.subject;
    hello.role = static_cast<std::uint8_t>(role);
    hello.icd_hash = icd_hash();
    hello.process_id = static_cast<std::uint32_t>(getpid());
    hello.flight_mode = tumblesight_icd_MODE_RUN;
    write(hellos_, hello);
  }
  // The frame seen last, upside down, as the one of the next step.
  void forge_frame() {
    LidarFrameSample frame = seen_.frame;
    std::reverse(std::begin(frame.ranges), std::end(frame.ranges));
    frame.sequence_number = k_;
    frame.exposure_time_ns = time_ns();
    write(frames_, frame);
  }
  void forge_navigation() {
    NavigationSample navigation{};
    navigation.time_ns = time_ns();
    navigation.q_inertial_lrf[1] = 1 << 30;
    navigation.valid = 1;
    write(navigations_, navigation);
  }
  void forge_command() {
    const hal::CommandPacket packet = ground_.packet(sim::set_mode(hal::Mode::kSafe));
    CommandSample command{};
    command.size = packet.size;
    std::copy(packet.bytes.begin(), packet.bytes.end(), command.bytes);
    write(commands_, command);
  }
  void forge_step() {
    StepSample step{};
    step.time_ns = time_ns();
    step.last = 1;
    StepContent{}.announce_in(step);
    write(steps_, step);
  }
  void forge_attitude() {
    AttitudeSample attitude = seen_.attitude;
    attitude.time_ns = attitude.exposure_time_ns = time_ns();
    attitude.sequence_number = k_;
    std::swap(attitude.q_lrf_trf[0], attitude.q_lrf_trf[1]);
    write(attitudes_, attitude);
  }
  void forge_telemetry() {
    TelemetrySample telemetry = seen_.telemetry;
    telemetry.time_ns = time_ns();
    telemetry.mode = tumblesight_icd_MODE_SAFE;
    write(telemetries_, telemetry);
  }
  void forge_event() {
    EventSample event{};
    event.time_ns = time_ns();
    event.id = 53;
    write(events_, event);
  }
  void forge_dump() {
    MemoryDumpSample dump{};
    dump.time_ns = time_ns();
    dump.size = 16;
    write(dumps_, dump);
  }
  void forge_step_done() {
    StepDoneSample done{};
    done.attitudes = done.telemetries = 1;
    done.state_crc32 = 0xBAD;
    write(steps_done_, done);
  }
  void forge_truth() {
    TruthSample truth{};
    truth.time_ns = time_ns();
    truth.q_lrf_trf[0] = 1.0F;
    write(truths_, truth);
  }
  std::int64_t time_ns() const {
    if (!seen_.step) return 2'700'000'000 * (std::int64_t{k_} + 1);
    return seen_.step->time_ns + 2'700'000'000 * (std::int64_t{k_} - seen_.step->k);
  }

  const Plan& plan_;
  const Domain& domain_;
  const Observer& seen_;
  sim::TelecommandEncoder ground_;
  std::uint32_t run_id_ = 0;
  std::uint32_t k_ = 0;
  std::uint32_t guess_ = 0;
  Writer<HelloSample> hellos_;
  Writer<LidarFrameSample> frames_;
  Writer<NavigationSample> navigations_;
  Writer<CommandSample> commands_;
  Writer<StepSample> steps_;
  Writer<AttitudeSample> attitudes_;
  Writer<TelemetrySample> telemetries_;
  Writer<EventSample> events_;
  Writer<MemoryDumpSample> dumps_;
  Writer<StepDoneSample> steps_done_;
  Writer<TruthSample> truths_;
};

int attack(const Plan& plan) {
  constexpr auto kLongest = std::chrono::seconds(30);
  Domain domain;
  Observer seen;
  if (domain.open(plan.domain, kEveryPartition) != 0 || !seen.open(domain)) return 3;
  Forger forger(plan, domain, seen);
  std::printf("ready\n");
  std::fflush(stdout);
  const auto end = std::chrono::steady_clock::now() + kLongest;
  while (std::chrono::steady_clock::now() < end) {
    seen.look();
    if (plan.begin_k == 0 || (seen.step && seen.step->k >= plan.begin_k)) forger.forge();
    usleep(2'000);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  sim::end_with_starter();
  if (argc != 6) return 2;
  Plan plan;
  plan.domain = static_cast<std::uint32_t>(std::atoi(argv[1]));
  plan.target = argv[2];
  plan.run_id_observed = std::strcmp(argv[3], "observed") == 0;
  plan.k_observed = std::strcmp(argv[4], "observed") == 0;
  plan.begin_k = static_cast<std::uint32_t>(std::atoi(argv[5]));
  return attack(plan);
}

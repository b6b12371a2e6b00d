#include "sim/sil/sil_session.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <thread>

#include "hal/dds/idl/icd_hash.hpp"
#include "hal/dds/idl/wait_limit.hpp"
#include "sim/host/interruption.hpp"
#include "sim/host/text.hpp"
#include "sim/recording/step_samples.hpp"

namespace tumblesight::sim {
namespace {

using namespace std::chrono_literals;
using hal::dds::Role;
using hal::dds::WaitLimit;

constexpr auto kPoll = 20ms;
constexpr auto kLook = 200ms;
constexpr double kEndGrace_s = 3.0;

// Throws SilFailure after a signal.
void require_not_interrupted() {
  const int signal = Interruption::signal();
  if (signal == 0) return;
  throw SilFailure(std::string("it was interrupted by signal ") + std::to_string(signal) + " (" +
                   strsignal(signal) + ")");
}

std::uint64_t now_ns() {
  return static_cast<std::uint64_t>(
      std::chrono::nanoseconds(SilSession::Clock::now().time_since_epoch()).count());
}

WaitLimit limit_of(double limit_s) {
  return {now_ns(), static_cast<std::uint64_t>(1e9 * limit_s)};
}

// As Ctrl-Z and a debugger stop a program.
bool is_stopped(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(file, text);
  // "pid (name) state ...": the name can hold any character; the last ')' ends it.
  const std::size_t end = text.rfind(") ");
  return end != std::string::npos && end + 2 < text.size() && (text[end + 2] == 'T' || text[end + 2] == 't');
}

// A flight program that the user starts does not know a secret, so it meets us in the default partition.
hal::dds::RunSecret make_secret(bool with_partition) {
  hal::dds::RunSecret secret;
  if (!hal::dds::make_run_secret(secret)) throw SilFailure("the system provides no random numbers");
  if (!with_partition) secret.partition[0] = '\0';
  return secret;
}

std::string hex(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "%08x", value);
  return text;
}

std::string last_line_of(const std::string& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);) {
    const bool is_note = line.find(": note: ") != std::string::npos;
    if (!line.empty() && !is_note) last = line;
  }
  return last;
}

[[noreturn]] void fail_foreign(const hal::dds::Foreigner& foreigner) {
  throw SilFailure(std::string("a program other than the flight program is on the bus: ") +
                   to_text(foreigner).text);
}

template <class Sample>
void write(hal::dds::Writer<Sample>& writer, const Sample& sample) {
  const dds_return_t result = writer.write(sample);
  if (result != 0) {
    throw SilFailure(std::string("DDS refused a sample of ") + hal::dds::topic_of<Sample>().name + ": " +
                     dds_strretcode(result));
  }
}

}  // namespace

SilSession::SilSession(const SilSettings& settings)
    : settings_(settings),
      lease_(settings.domain),
      secret_(make_secret(!settings.flight_path.empty())),
      check_(settings.free_running),
      encoder_(settings.command_key) {
  const auto security = std::make_unique<hal::dds::SecurityElement>();
  if (!settings_.security_path.empty() &&
      !hal::dds::read_security(settings_.security_path.c_str(), *security))
    throw SilFailure("--dds-security " + settings_.security_path + ": cannot be read, is empty, or has " +
                     std::to_string(sizeof security->text) + " bytes or more");
  open_domain(security->text);
  endpoints_ = std::make_unique<SimulatorEndpoints>(domain_);
  answers_ = std::make_unique<AnswerCollector>(*endpoints_, secret_.run_id);
  announcement_ = std::make_unique<RunAnnouncement>(lease_.domain(), secret_);
  if (!announcement_->failure().empty()) print_note(announcement_->failure());
  // Before the flight program starts, so that it finds the recording as early as the other endpoints.
  if (!settings_.mcap_path.empty())
    recorder_ = std::make_unique<RunRecorder>(domain_, settings_.mcap_path, settings_.swath_m);
  life_.show(lease_.domain(), hello());
  write(endpoints_->hello_out, hello());
  if (!settings_.flight_path.empty()) start_flight();
  shake_hands();
}

// Another program may have the UDP ports of a domain that no run uses: then the next one is tried.
void SilSession::open_domain(const char* security) {
  constexpr int kTries = 10;
  constexpr std::uint32_t kFirstPort = 7400, kPortsPerDomain = 250;
  const std::uint32_t first = lease_.domain();
  const dds_return_t result = domain_.open(first, secret_.partition, security);
  if (result == 0) return;
  const std::string domain =
      "DDS domain " + std::to_string(first) + " could not be opened: " + hal::dds::text_of_failure(result);
  if (!hal::dds::has_loopback()) throw SilFailure(domain);
  if (!settings_.security_path.empty())
    throw SilFailure(domain + "; is --dds-security " + settings_.security_path +
                     " a file of hal/dds/make_security?");
  const std::uint32_t port = kFirstPort + kPortsPerDomain * first;
  const std::string reason = "; another program may have its UDP ports, " + std::to_string(port) + " to " +
                             std::to_string(port + kPortsPerDomain - 1);
  for (int i = 1; settings_.domain < 0 && i < kTries && lease_.take_next(); ++i) {
    if (domain_.open(lease_.domain(), secret_.partition, security) != 0) continue;
    print_note(domain + reason + "; the run is in domain " + std::to_string(lease_.domain()));
    return;
  }
  throw SilFailure(domain + reason + ": give another --domain");
}

hal::dds::HelloSample SilSession::hello() const {
  hal::dds::HelloSample hello{};
  hello.role = static_cast<std::uint8_t>(Role::kSimulator);
  hello.icd_hash = hal::dds::icd_hash();
  hello.run_id = secret_.run_id;
  hello.process_id = static_cast<std::uint32_t>(getpid());
  hello.model_crc32 = settings_.model_crc32;
  hal::dds::set_target(hello, settings_.target.c_str());
  return hello;
}

std::vector<std::string> SilSession::flight_command_line() const {
  std::vector<std::string> arguments{"--target", settings_.target, "--domain",
                                     std::to_string(lease_.domain())};
  if (!settings_.model_path.empty()) arguments.insert(arguments.end(), {"--model", settings_.model_path});
  if (!settings_.security_path.empty())
    arguments.insert(arguments.end(), {"--dds-security", settings_.security_path});
  if (settings_.free_running) {
    const double period_ms = kFramePeriod_s * 1e3 / settings_.speed;
    arguments.insert(arguments.end(), {"--mode", "free-running", "--period-ms", std::to_string(period_ms)});
  }
  arguments.insert(arguments.end(), settings_.flight_arguments.begin(), settings_.flight_arguments.end());
  return arguments;
}

void SilSession::start_flight() {
  process_ = std::make_unique<FlightProcess>(
      settings_.flight_path, flight_command_line(), settings_.flight_log_path, lease_.file(),
      std::vector<std::string>{std::string(hal::dds::kRunSecretVariable) + "=" + to_text(secret_).text});
}

// Reads the hellos of flight. The first one decides which program it is; a difference ends the run.
void SilSession::read_hello() {
  hal::dds::HelloSample hello;
  hal::dds::PeerKey from;
  while (endpoints_->hello_in.take(hello, from)) {
    const bool ours = hello.run_id == secret_.run_id || hello.run_id == 0;
    if (hello.role != static_cast<std::uint8_t>(Role::kFlight) || !ours)
      fail_foreign(endpoints_->hello_in.describe(from));
    bind(hello, from);
    const std::string difference = difference_to(hello);
    if (!difference.empty()) {
      wait_for_refusal_of(from);
      throw SilFailure(difference);
    }
    flight_mode_ = static_cast<hal::Mode>(hello.flight_mode);
    encoder_.continue_after(hello.command_counter);
    flight_ready_ |= hello.run_id == secret_.run_id;
  }
}

// Empty, or what the flight program has and this run has not.
std::string SilSession::difference_to(const hal::dds::HelloSample& flight) const {
  switch (hal::dds::fit(hello(), flight)) {
    case hal::dds::HelloFit::kFits:
      return {};
    case hal::dds::HelloFit::kOtherInterface:
      return "interface hash " + hex(hal::dds::icd_hash()) + ", but " + hex(flight.icd_hash) +
             " in the flight program: build both from the same tumblesight.idl";
    case hal::dds::HelloFit::kOtherTarget:
      return "target " + settings_.target + ", but " + hal::dds::target_of(flight).text +
             " in the flight program: give both the same --target";
    case hal::dds::HelloFit::kOtherModel:
      return "model image " + settings_.model_path + " (CRC-32 " + hex(settings_.model_crc32) +
             "), but CRC-32 " + hex(flight.model_crc32) +
             " in the flight program: give both the same --model; without it each takes the image that ships "
             "for the target";
  }
  return {};
}

// Flight refuses as well, with a message of its own. It must read our hello before we leave.
void SilSession::wait_for_refusal_of(const hal::dds::PeerKey& flight) {
  if (process_) {
    (void)process_->wait_for_end(kEndGrace_s);
    return;
  }
  const auto deadline = Clock::now() + std::chrono::duration<double>(kEndGrace_s);
  while (hal::dds::writer_of(flight, endpoints_->hello_in.entity()) != 0 && Clock::now() < deadline)
    std::this_thread::sleep_for(kPoll);
}

void SilSession::bind(const hal::dds::HelloSample& hello, const hal::dds::PeerKey& from) {
  if (process_ && hello.process_id != static_cast<std::uint32_t>(process_->pid())) {
    throw SilFailure("process " + std::to_string(hello.process_id) +
                     " announced itself as the flight program, which is process " +
                     std::to_string(process_->pid()));
  }
  if (flight_ && !hal::dds::same_peer(*flight_, from))
    throw SilFailure("two flight programs are on DDS domain " + std::to_string(lease_.domain()) +
                     ": end one of them, or give this run and its flight program another --domain");
  if (!process_ && !flight_) life_.watch(lease_.domain(), hello);
  flight_ = from;
}

void SilSession::shake_hands() {
  WaitLimit limit = limit_of(settings_.step_timeout_s);
  while (!flight_ready_ || !endpoints_->bind(*flight_) || (recorder_ && !recorder_->has_writers())) {
    require_not_interrupted();
    read_hello();
    require_no_foreigner();
    const hal::dds::Mismatch mismatch = endpoints_->hello_in.latest_mismatch();
    other_run_seen_ |= mismatch == hal::dds::Mismatch::kPartition;
    if (mismatch == hal::dds::Mismatch::kInterface) {
      throw SilFailure(
          "the hello of the flight program has another type: build both from the same tumblesight.idl");
    }
    if (process_ && !process_->running()) {
      read_hello();  // the last one may have arrived in between
      fail("the flight program " + process_->how_it_ended());
    }
    if (!process_ && life_.peer_ended()) fail_flight_ended();
    if (limit.is_over(now_ns())) {
      if (flight_ready_ && endpoints_->bind(*flight_))
        fail("the recording of --mcap does not find the topics of the run on the bus");
      fail_without_hello();
    }
    endpoints_->wait_for_data(1'000'000);
  }
}

void SilSession::fail_without_hello() const {
  const std::string domain = std::to_string(lease_.domain());
  const std::string other_run =
      other_run_seen_ ? "; another run is in DDS domain " + domain + ": give this one another --domain" : "";
  fail((process_ ? "the flight program was started but did not announce itself"
                 : "no flight program announced itself in DDS domain " + domain +
                       "; start one with --domain " + domain) +
       other_run);
}

// The run must not go on: who writes to our topics could also delay or suppress what flight writes.
void SilSession::require_no_foreigner() {
  const hal::dds::Foreigner foreigner = endpoints_->foreigner();
  if (foreigner) fail_foreign(foreigner);
}

void SilSession::fail(const std::string& what) const {
  const std::string message =
      settings_.flight_log_path.empty() ? "" : last_line_of(settings_.flight_log_path);
  throw SilFailure(message.empty() ? what : what + " [" + message + "]");
}

bool SilSession::flight_ended() {
  return (process_ && !process_->running()) || endpoints_->flight_gone() || life_.peer_ended();
}

// The exit status is known only of a flight program that we started.
bool SilSession::flight_ended_after_last_step() {
  if (!last_sent_) return false;
  return !process_ || (process_->wait_for_end(kEndGrace_s) && process_->ended_well());
}

void SilSession::fail_flight_ended() const {
  require_not_interrupted();  // a terminal sends the signal to both programs
  const std::string step = next_k_ == 0 ? "before step 0" : "at step " + std::to_string(next_k_ - 1);
  if (!process_ && life_.peer_ended())
    fail("the flight program has ended " + step + "; see its messages, and start both again");
  if (!process_ || !process_->ended())
    fail("the connection to the flight program was lost " + step +
         ": it has left the bus, or one of the two programs was paused for an hour; start both again");
  fail("the flight program " + process_->how_it_ended() + ", " + step + "; see its messages, and run again");
}

StepAnswer SilSession::step(const StepInput& input) {
  const std::uint32_t k = next_k_;
  send(input);
  return wait_for_answer(k);
}

void SilSession::send(const StepInput& input) {
  require_not_interrupted();
  const std::uint32_t k = next_k_++;
  check_.sent(k, input.time_ns, input.frames);
  StepInput sent = input;
  sent.packets.clear();
  for (const Telecommand& command : input.commands) sent.packets.push_back(encoder_.packet(command));
  sent.packets.insert(sent.packets.end(), input.packets.begin(), input.packets.end());
  write_step({secret_.run_id, k}, sent, frame_sample_,
             [this](const auto& sample) { write(endpoints_->writer_of(sample), sample); });
  last_sent_ = input.last;
  if (recorder_) recorder_->add(input.frames, input.time_ns);
}

// Lockstep has no reason to end with a pause of this program, which therefore does not count.
StepAnswer SilSession::wait_for_answer(std::uint32_t k) {
  WaitLimit limit = limit_of(settings_.step_timeout_s);
  do {
    if (const std::optional<StepAnswer> answer = next_answer(Clock::now() + kLook)) return *answer;
    if (flight_ended()) fail_flight_ended();
  } while (!limit.is_over(now_ns()));
  fail("the flight program did not answer step " + std::to_string(k) + " within " +
       std::to_string(settings_.step_timeout_s) + " s of wall-clock time" +
       (process_ && is_stopped(process_->pid()) ? ": it is stopped, by a signal or a debugger" : ""));
}

std::optional<StepAnswer> SilSession::collect_answer() {
  answers_->collect();
  require_no_foreigner();
  std::optional<StepAnswer> answer = answers_->next();
  if (!answer) return answer;
  if (recorder_) recorder_->add(*answer);  // also a wrong one, which the recording explains
  const std::string fault = check_.fault_of(*answer);
  if (!fault.empty()) throw SilFailure(fault);
  return answer;
}

std::optional<StepAnswer> SilSession::next_answer(Clock::time_point deadline) {
  for (;;) {
    require_not_interrupted();
    if (auto answer = collect_answer()) return answer;
    if (recorder_) recorder_->write_due();
    const auto left = deadline - Clock::now();
    if (left <= Clock::duration::zero()) return std::nullopt;
    const bool arrived = endpoints_->wait_for_data(std::min<Clock::duration>(left, kPoll).count());
    if (!arrived && flight_ended()) {
      if (auto answer = collect_answer()) return answer;  // the last samples may have arrived in between
      if (flight_ended_after_last_step()) return std::nullopt;
      fail_flight_ended();
    }
  }
}

void SilSession::sleep_until(Clock::time_point time) {
  while (Clock::now() < time) {
    std::this_thread::sleep_until(std::min(time, Clock::now() + 200ms));
    require_not_interrupted();
    if (recorder_) recorder_->write_due();
    if (flight_ended()) fail_flight_ended();
  }
}

void SilSession::finish() {
  if (recorder_) recorder_->close();
  if (!process_) return;
  if (!process_->wait_for_end(settings_.step_timeout_s))
    fail("the flight program did not end after its last step");
  if (!process_->ended_well())
    fail("the flight program " + process_->how_it_ended() + ", after the last step");
}

void SilSession::publish_truth(std::uint32_t sequence, std::uint32_t frame, const FrameTruth& truth,
                               std::int64_t time_ns, std::int64_t exposure_time_ns) {
  write(endpoints_->truth, truth_sample({secret_.run_id, next_k_}, sequence, frame, truth, time_ns));
  if (recorder_) recorder_->add(truth, exposure_time_ns);
}

}  // namespace tumblesight::sim

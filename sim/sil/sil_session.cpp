#include "sim/sil/sil_session.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <random>
#include <thread>

#include "hal/dds/idl/icd_hash.hpp"

namespace tumblesight::sim {
namespace {

using namespace std::chrono_literals;
using hal::dds::Role;

constexpr auto kPoll = 20ms;
constexpr double kEndGrace_s = 3.0;

// Not 0, which stands for "any" and "not ready".
std::uint32_t make_run_id() {
  return std::max(1U, static_cast<std::uint32_t>(std::random_device{}()));
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
    if (!line.empty()) last = line;
  }
  return last;
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
    : settings_(settings), lease_(settings.domain), run_id_(make_run_id()), encoder_(settings.command_key) {
  const dds_return_t result = domain_.open(lease_.domain());
  if (result != 0) {
    throw SilFailure("DDS domain " + std::to_string(lease_.domain()) +
                     " could not be opened: " + dds_strretcode(result));
  }
  endpoints_ = std::make_unique<SimulatorEndpoints>(domain_.participant());
  answers_ = std::make_unique<AnswerCollector>(*endpoints_, run_id_);
  hal::dds::HelloSample hello{};
  hello.role = static_cast<std::uint8_t>(Role::kSimulator);
  hello.icd_hash = hal::dds::icd_hash();
  hello.run_id = run_id_;
  hello.process_id = static_cast<std::uint32_t>(getpid());
  write(endpoints_->hello_out, hello);
  if (!settings_.flight_path.empty()) start_flight();
  shake_hands();
}

std::vector<std::string> SilSession::flight_command_line() const {
  std::vector<std::string> arguments{"--target", settings_.target,
                                     "--domain", std::to_string(lease_.domain()),
                                     "--run-id", std::to_string(run_id_)};
  if (!settings_.model_path.empty()) arguments.insert(arguments.end(), {"--model", settings_.model_path});
  if (settings_.free_running) {
    const double period_ms = kFramePeriod_s * 1e3 / settings_.speed;
    arguments.insert(arguments.end(), {"--mode", "free-running", "--period-ms", std::to_string(period_ms)});
  }
  arguments.insert(arguments.end(), settings_.flight_arguments.begin(), settings_.flight_arguments.end());
  return arguments;
}

void SilSession::start_flight() {
  process_ = std::make_unique<FlightProcess>(settings_.flight_path, flight_command_line(),
                                             settings_.flight_log_path, lease_.file());
}

// True once flight of this run is ready.
bool SilSession::read_hello() {
  bool ready = false;
  hal::dds::HelloSample hello;
  while (endpoints_->hello_in.take(hello)) {
    const bool ours = hello.run_id == run_id_ || hello.run_id == 0;
    if (hello.role != static_cast<std::uint8_t>(Role::kFlight) || !ours) continue;
    if (hello.icd_hash != hal::dds::icd_hash()) {
      // Flight refuses as well: let it say so itself.
      if (process_) (void)process_->wait_for_end(kEndGrace_s);
      throw SilFailure("interface hash " + hex(hal::dds::icd_hash()) + ", flight's " + hex(hello.icd_hash) +
                       ": build both from the same tumblesight.idl");
    }
    flight_mode_ = static_cast<hal::Mode>(hello.flight_mode);
    ready = hello.run_id == run_id_;
  }
  return ready;
}

void SilSession::shake_hands() {
  const auto deadline = Clock::now() + std::chrono::duration<double>(settings_.step_timeout_s);
  bool ready = false;
  while (!ready || !endpoints_->all_matched()) {
    ready = read_hello() || ready;
    if (endpoints_->hello_in.saw_incompatible()) {
      throw SilFailure("flight's hello is of another type: build both from the same tumblesight.idl");
    }
    if (process_ && !process_->running()) fail("flight " + process_->how_it_ended());
    if (Clock::now() > deadline) {
      fail(process_ ? "flight was started but did not announce itself"
                    : "no flight program announced itself in DDS domain " + std::to_string(lease_.domain()) +
                          "; start one with --domain " + std::to_string(lease_.domain()));
    }
    endpoints_->wait_for_data(1'000'000);
  }
}

void SilSession::fail(const std::string& what) const {
  const std::string message =
      settings_.flight_log_path.empty() ? "" : last_line_of(settings_.flight_log_path);
  throw SilFailure(message.empty() ? what : what + " [" + message + "]");
}

bool SilSession::flight_ended() {
  return (process_ && !process_->running()) || endpoints_->flight_gone();
}

// Of a flight program that somebody else has started, only its going is seen, not how it went.
bool SilSession::flight_ended_as_it_should() {
  if (!last_sent_) return false;
  return !process_ || (process_->wait_for_end(kEndGrace_s) && process_->ended_well());
}

void SilSession::fail_flight_ended() const {
  const std::string step = next_k_ == 0 ? "before step 0" : "at step " + std::to_string(next_k_ - 1);
  if (!process_ || !process_->ended())
    fail("the connection to flight was lost " + step + "; start both again");
  fail("flight " + process_->how_it_ended() + ", " + step + "; see what it wrote, and run again");
}

StepAnswer SilSession::step(const StepInput& input) {
  const std::uint32_t k = next_k_;
  send(input);
  return wait_for_answer(k);
}

void SilSession::send(const StepInput& input) {
  const std::uint32_t k = next_k_++;
  for (const gnc::RangeImage* frame : input.frames) {
    frame_sample_.run_id = run_id_;
    frame_sample_.k = k;
    frame_sample_.sequence_number = frame->sequence_number;
    frame_sample_.exposure_time_ns = frame->exposure_time_ns;
    frame_sample_.fov_urad = frame->fov_urad;
    frame_sample_.rays = frame->rays;
    std::copy(frame->ranges.begin(), frame->ranges.end(), frame_sample_.ranges);
    write(endpoints_->frames, frame_sample_);
  }
  std::vector<hal::CommandPacket> packets;
  for (const Telecommand& command : input.commands) packets.push_back(encoder_.packet(command));
  packets.insert(packets.end(), input.packets.begin(), input.packets.end());
  for (const hal::CommandPacket& packet : packets) {
    hal::dds::CommandSample sample{};
    sample.run_id = run_id_;
    sample.k = k;
    sample.size = packet.size;
    std::copy(packet.bytes.begin(), packet.bytes.end(), sample.bytes);
    write(endpoints_->commands, sample);
  }
  hal::dds::StepSample step{};
  step.run_id = run_id_;
  step.k = k;
  step.time_ns = input.time_ns;
  step.frames = static_cast<std::uint8_t>(input.frames.size());
  step.commands = static_cast<std::uint8_t>(packets.size());
  step.last = input.last ? 1 : 0;
  write(endpoints_->steps, step);
  last_sent_ = input.last;
}

StepAnswer SilSession::wait_for_answer(std::uint32_t k) {
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(settings_.step_timeout_s));
  while (const std::optional<StepAnswer> answer = next_answer(deadline)) {
    if (answer->k == k) return *answer;
  }
  if (flight_ended()) fail_flight_ended();
  fail("flight did not answer step " + std::to_string(k) + " within " +
       std::to_string(settings_.step_timeout_s) + " s of wall-clock time");
}

std::optional<StepAnswer> SilSession::next_answer(Clock::time_point deadline) {
  for (;;) {
    answers_->collect();
    if (auto answer = answers_->next()) return answer;
    const auto left = deadline - Clock::now();
    if (left <= Clock::duration::zero()) return std::nullopt;
    const bool arrived = endpoints_->wait_for_data(std::min<Clock::duration>(left, kPoll).count());
    if (!arrived && flight_ended()) {
      answers_->collect();  // its last words may have come in between
      if (auto answer = answers_->next()) return answer;
      if (flight_ended_as_it_should()) return std::nullopt;
      fail_flight_ended();
    }
  }
}

void SilSession::sleep_until(Clock::time_point time) {
  while (Clock::now() < time) {
    std::this_thread::sleep_until(std::min(time, Clock::now() + 200ms));
    if (flight_ended()) fail_flight_ended();
  }
}

void SilSession::finish() {
  if (!process_) return;
  if (!process_->wait_for_end(settings_.step_timeout_s)) fail("flight did not end after its last step");
  if (!process_->ended_well()) fail("flight " + process_->how_it_ended() + ", after the last step");
}

void SilSession::publish_truth(std::uint32_t sequence, std::uint32_t frame, const FrameTruth& truth,
                               std::int64_t time_ns) {
  hal::dds::TruthSample sample{};
  sample.run_id = run_id_;
  sample.k = next_k_;
  sample.time_ns = time_ns;
  sample.sequence_index = sequence;
  sample.frame_index = frame;
  const Eigen::Quaternionf q = truth.q_lrf_trf.cast<float>();
  const float scalar_first[] = {q.w(), q.x(), q.y(), q.z()};
  std::copy(std::begin(scalar_first), std::end(scalar_first), sample.q_lrf_trf);
  for (int i = 0; i < 3; ++i) sample.rate_lrf_rad_s[i] = static_cast<float>(truth.rate_lrf_rad_s[i]);
  sample.range_m = static_cast<float>(truth.range_m);
  write(endpoints_->truth, sample);
}

}  // namespace tumblesight::sim

#include "sim/console/bus_run.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <utility>

#include "sim/recording/cdr_sample.hpp"
#include "sim/recording/each_topic.hpp"
#include "sim/recording/step_samples.hpp"
#include "sim/sil/failure.hpp"
#include "sim/sil/run_control.hpp"

namespace tumblesight::sim {
namespace {

constexpr dds_duration_t kPoll = DDS_MSECS(50);
constexpr auto kBetweenLooks = std::chrono::milliseconds(30);
constexpr auto kUsualWait = std::chrono::seconds(5);  // until topics of an announced run are found
constexpr int kAnswerTimeout_ms = 5000;  // a run at the speed of flight takes requests every 2.7 s

dds_entity_t checked(dds_entity_t entity) {
  if (entity < 0)
    throw SilFailure(std::string("the console could not join the bus: ") + hal::dds::text_of_failure(entity));
  return entity;
}

template <class Sample, class Readers>
dds_entity_t reader_of(const Readers& readers) {
  const hal::dds::Topic* const topic = &hal::dds::topic_of<Sample>();
  return std::find_if(readers.begin(), readers.end(),
                      [topic](const auto& reader) { return reader.first == topic; })
      ->second;
}

}  // namespace

BusRun::BusRun(int domain, const std::string& security_path, const std::string& mcap_path)
    : domain_(domain),
      mcap_path_(mcap_path),
      security_(std::make_unique<hal::dds::SecurityElement>()),
      frame_sample_(std::make_unique<hal::dds::LidarFrameSample>()) {
  if (!security_path.empty() && !hal::dds::read_security(security_path.c_str(), *security_))
    throw SilFailure("--dds-security " + security_path + ": cannot be read, is empty, or has " +
                     std::to_string(sizeof security_->text) + " bytes or more");
  thread_ = std::thread([this] { look_for_runs(); });
}

BusRun::~BusRun() {
  is_stopping_ = true;
  thread_.join();
}

std::unique_ptr<BusRun::Connection> BusRun::connect(const AnnouncedRun& run) const {
  auto made = std::make_unique<Connection>();
  made->secret = run.secret;
  checked(made->domain.open(run.domain, made->secret.partition, security_->text));
  made->participant = made->domain.participant();
  made->waitset = checked(dds_create_waitset(made->participant));
  each_topic([&made](auto type, const char*) { open<typename decltype(type)::type>(*made); });
  return made;
}

template <class Sample>
void BusRun::open(Connection& connection) {
  const hal::dds::Topic& topic = hal::dds::topic_of<Sample>();
  const dds_entity_t reader = checked(hal::dds::create_reader(connection.domain, topic));
  dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
  dds_waitset_attach(connection.waitset, reader, 0);
  connection.readers.emplace_back(&topic, reader);
}

// Takes every sample of a topic. True: there was one.
template <class Sample>
bool BusRun::take(Connection& connection, Sample& sample) {
  const hal::dds::Topic& topic = hal::dds::topic_of<Sample>();
  const dds_entity_t reader = reader_of<Sample>(connection.readers);
  std::vector<std::uint8_t> bytes;
  bool any = false;
  while (take_cdr(reader, bytes)) {
    any = true;
    begin_recording();
    if (!read_cdr(bytes.data(), bytes.size(), sample)) continue;
    if constexpr (std::is_same_v<Sample, hal::dds::HelloSample>) connection.watch_life(sample);
    show(sample);
    record([&](JoinedRecording& recording) {
      if constexpr (std::is_same_v<Sample, hal::dds::HelloSample>) {
        recording.add(topic, bytes, std::nullopt);
      } else {
        if constexpr (std::is_same_v<Sample, hal::dds::StepSample>)
          recording.add_step(sample.k, sample.time_ns);
        recording.add(topic, bytes, sample.k);
      }
    });
  }
  return any;
}

// A recording that fails ends. What the page shows goes on.
template <class Action>
void BusRun::record(const Action& action) {
  if (!recording_) return;
  try {
    action(*recording_);
  } catch (const std::exception& failure) {
    recording_.reset();
    note(failure.what());
  }
}

void BusRun::note(const std::string& failure) {
  const std::lock_guard lock(mutex_);
  failure_ = failure;
}

// What the page shows; other samples are only recorded.
template <class Sample>
void BusRun::show(const Sample& sample) {
  if constexpr (std::is_same_v<Sample, hal::dds::LidarFrameSample>) {
    keep(sample);
    log_.add(sample);
  } else if constexpr (!std::is_same_v<Sample, hal::dds::NavigationSample> &&
                       !std::is_same_v<Sample, hal::dds::MemoryDumpSample>) {
    log_.add(sample);
  }
}

// DDS tells late that the simulator was killed.
void BusRun::Connection::watch_life(const hal::dds::HelloSample& hello) {
  const bool is_simulator = hello.role == static_cast<std::uint8_t>(hal::dds::Role::kSimulator);
  if (is_simulator && hello.run_id == secret.run_id) simulator_life.watch(domain.id(), hello);
}

bool BusRun::take_samples(Connection& connection) {
  bool any = false;
  each_topic([&](auto type, const char*) {
    using Sample = typename decltype(type)::type;
    if constexpr (std::is_same_v<Sample, hal::dds::LidarFrameSample>) {
      any |= take(connection, *frame_sample_);
    } else {
      Sample sample;
      any |= take(connection, sample);
    }
  });
  return any;
}

void BusRun::keep(const hal::dds::LidarFrameSample& sample) {
  const bool is_possible = sample.rays > 0 && sample.rays <= gnc::RangeImage::kMaxRays;
  if (!is_possible || sample.run_id != followed_run_) return;
  const std::lock_guard lock(mutex_);
  if (sample.run_id != run_of_frames_) frames_.clear();
  run_of_frames_ = sample.run_id;
  KeptFrame& kept = frames_.emplace_back();
  kept.k = sample.k;
  kept.frame = frame_of(sample);
  if (frames_.size() > kFramesKept) frames_.pop_front();
}

// Until the simulator has left, and nothing has come since. One that was never seen on the bus is waited for
// until its announcement is gone, or that of a newer run is there.
void BusRun::follow(Connection& connection, std::uint32_t domain) {
  const dds_entity_t steps = reader_of<hal::dds::StepSample>(connection.readers);
  const auto late = std::chrono::steady_clock::now() + kUsualWait;
  bool had_simulator = false, is_noted = false;
  while (!is_stopping_) {
    dds_attach_t triggered[1];
    dds_waitset_wait(connection.waitset, triggered, 1, kPoll);
    const bool has_simulator =
        dds_get_matched_publications(steps, nullptr, 0) > 0 && !connection.simulator_life.peer_ended();
    const bool any = take_samples(connection);
    record([](JoinedRecording& recording) { recording.poll(); });
    had_simulator |= has_simulator || any;
    if (had_simulator ? !has_simulator && !any : !is_newest(connection.secret.run_id)) break;
    if (had_simulator || is_noted || std::chrono::steady_clock::now() < late) continue;
    is_noted = true;
    note("the run in DDS domain " + std::to_string(domain) +
         " is announced, but its topics are not on the bus; was it started with another --dds-security?");
  }
  log_.end();
}

std::optional<AnnouncedRun> BusRun::newest_run() {
  try {
    return announced_run(domain_);
  } catch (const SilFailure& failure) {  // of the folder
    note(failure.what());
    return std::nullopt;
  }
}

bool BusRun::is_newest(std::uint32_t run_id) {
  const std::optional<AnnouncedRun> run = newest_run();
  return run && run->secret.run_id == run_id;
}

// With the first sample of the first run that is seen.
void BusRun::begin_recording() {
  const std::string path = std::exchange(mcap_path_, {});
  if (path.empty()) return;
  try {
    recording_ = std::make_unique<JoinedRecording>(path, *this);
  } catch (const std::exception& failure) {
    note(failure.what());
  }
}
void BusRun::end_recording() {
  record([](JoinedRecording& recording) { recording.close(); });
  recording_.reset();
}

std::string BusRun::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void BusRun::join(std::optional<std::uint32_t> domain) {
  const std::lock_guard lock(mutex_);
  joined_ = domain;
}

void BusRun::look_for_runs() {
  std::uint32_t last_run = 0;
  while (!is_stopping_) {
    const std::optional<AnnouncedRun> run = newest_run();
    if (run && run->secret.run_id != last_run) {
      last_run = followed_run_ = run->secret.run_id;
      try {
        const std::unique_ptr<Connection> connection = connect(*run);
        join(run->domain);
        follow(*connection, run->domain);
        end_recording();
      } catch (const std::exception& failure) {  // of the bus
        note(failure.what());
        recording_.reset();
        log_.end();
      }
      join(std::nullopt);
    }
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

std::string BusRun::title() const {
  char text[64];
  std::snprintf(text, sizeof text, ", run %08x", log_.state().run_id);
  const std::string target = log_.target();
  if (!target.empty()) return target + text;
  const std::lock_guard lock(mutex_);
  return failure_.empty() ? "waiting for a run: start sim/run or tumblesight simulate" : failure_;
}

std::string BusRun::ask(const std::string& request) const {
  std::optional<std::uint32_t> domain;
  {
    const std::lock_guard lock(mutex_);
    domain = joined_;
  }
  if (!domain) throw SilFailure("there is no run to ask: start one");
  return ask_run(*domain, request, kAnswerTimeout_ms);
}

std::uint64_t BusRun::first_frame() const {
  const std::lock_guard lock(mutex_);
  return frames_.empty() ? 0 : log_.number_of(frames_.front().k);
}

bool BusRun::frame(std::uint64_t step, gnc::RangeImage& frame) const {
  const std::int64_t k = log_.k_of(step);
  const std::uint32_t run = log_.state().run_id;
  const std::lock_guard lock(mutex_);
  if (run != run_of_frames_) return false;  // of the run before
  const auto found =
      std::find_if(frames_.rbegin(), frames_.rend(), [k](const KeptFrame& kept) { return kept.k == k; });
  if (found == frames_.rend()) return false;
  frame = found->frame;
  return true;
}

}  // namespace tumblesight::sim

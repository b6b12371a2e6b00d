#include "tests/sil/sil_test_support.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <stdexcept>
#include <thread>

#include "hal/dds/idl/machine_name.hpp"
#include "sim/sil/runtime_folder.hpp"
#include "sim/world/frame_renderer.hpp"
#include "sim/world/math/random.hpp"
#include "sim/world/target/shipped_meshes.hpp"
#include "tests/support/test_models.hpp"

namespace tumblesight::sim::test {
namespace {

namespace fs = std::filesystem;

class TemporaryFolder {
 public:
  TemporaryFolder() : path_(fs::temp_directory_path() / ("tumblesight-sil-" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::vector<std::uint8_t> make_model() {
  gnc::ModelHeader header = gnc::test_header();
  header.projection.swath_mm = static_cast<std::uint32_t>(1e3 * kSwath_m);
  header.projection.target_radius_mm = header.projection.swath_mm / 2;
  if (!gnc::set_target(header, kTarget)) throw std::logic_error("the test's target has no usable name");
  return gnc::random_model_image<gnc::FixedPoint>(1, header);
}

pid_t parent_of(pid_t pid) {
  // "pid (comm) state ppid": comm can hold any character; the last ')' ends it.
  const std::string stat = read_file("/proc/" + std::to_string(pid) + "/stat");
  const std::size_t end = stat.rfind(") ");
  return end == std::string::npos ? 0 : static_cast<pid_t>(std::atol(stat.c_str() + end + 4));
}

// For this process until its end, so that concurrent tests do not meet. DomainLease is the run's own.
bool reserve(int domain) {
  static std::deque<hal::dds::MachineName> held;
  const int error = held.emplace_back().hold(("tumblesight-test-domain-" + std::to_string(domain)).c_str());
  if (error == 0) return true;
  held.pop_back();
  if (error != EADDRINUSE) throw SilFailure(std::string("no test domain: ") + std::strerror(error));
  return false;
}

bool is_free(int domain) {
  try {
    const DomainLease lease(domain);
    return true;
  } catch (const SilFailure&) {
    return false;
  }
}

}  // namespace

std::string temporary_path(const std::string& name) {
  static const TemporaryFolder folder;
  static std::atomic<int> count{0};
  return folder.path() / (std::to_string(count++) + "-" + name);
}

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

const std::vector<std::uint8_t>& model_bytes() {
  static const std::vector<std::uint8_t> bytes = make_model();
  return bytes;
}

const std::string& model_path() {
  static const std::string path = [] {
    const std::string file = temporary_path("model.tsm");
    write_file(file, model_bytes());
    return file;
  }();
  return path;
}

SilSettings settings() {
  SilSettings result;
  result.target = kTarget;
  result.model_path = model_path();
  result.flight_path = TUMBLESIGHT_FLIGHT;
  result.flight_log_path = temporary_path("flight.log");
  return result;
}

SilSettings shipped_settings(const std::string& mcap_path) {
  SilSettings shipped = settings();
  shipped.target = "near_shoemaker";
  shipped.model_path = TUMBLESIGHT_SHIPPED_MODEL;
  shipped.mcap_path = mcap_path;
  shipped.swath_m = kSwath_m;
  return shipped;
}

SilRunResult run_shipped(const std::string& mcap_path, int count) {
  return run_sil(shipped_settings(mcap_path), lidar(), kSwath_m, sequences(count, 1), {});
}

std::string simulate(const std::string& options) {
  const std::string command = std::string(TUMBLESIGHT_PROGRAM) + " simulate --sequences 2 --report " +
                              temporary_path("report.html") + " " + options + " 2>&1";
  std::string text;
  FILE* const output = popen(command.c_str(), "r");
  for (int c = std::fgetc(output); c != EOF; c = std::fgetc(output)) text += static_cast<char>(c);
  if (pclose(output) != 0) throw std::runtime_error(command + ":\n" + text);
  return text;
}

std::string trace_of(const std::string& printed) {
  const std::size_t at = printed.find("trace CRC-32");
  return at == std::string::npos ? printed : printed.substr(at, printed.find('\n', at) - at);
}

const FlashLidar& lidar() {
  static const FlashLidar instance(make_near_shoemaker());
  return instance;
}

std::vector<Sequence> sequences(int count, std::uint64_t seed) {
  std::vector<Sequence> result;
  for (int i = 0; i < count; ++i) {
    result.push_back(make_sequence({Condition::kNominal}, seed, static_cast<std::uint64_t>(i)));
  }
  return result;
}

// So many that a frame is not taken for one of the last eight used ones, also after some steps without a
// frame.
const std::vector<gnc::RangeImage>& frames() {
  static const std::vector<gnc::RangeImage> instance = [] {
    constexpr unsigned kSequences = 4;
    std::vector<gnc::RangeImage> images;
    for (unsigned n = 0; n < kSequences; ++n) {
      const Sequence sequence = make_sequence({Condition::kNominal}, 5, n);
      for (std::uint32_t i = 0; i < sequence.frames.size(); ++i)
        FrameRenderer(lidar(), kSwath_m).render(sequence, i, images.emplace_back());
    }
    return images;
  }();
  return instance;
}

gnc::RangeImage Conversation::good_frame() const {
  gnc::RangeImage frame = frames()[k % frames().size()];
  frame.sequence_number = k;
  frame.exposure_time_ns = time_ns(k);
  return frame;
}

StepAnswer Conversation::step(const std::vector<gnc::RangeImage>& frames_of_step,
                              std::vector<Telecommand> commands, bool last) {
  StepInput input;
  input.time_ns = time_ns(k);
  for (const gnc::RangeImage& frame : frames_of_step) input.frames.push_back(&frame);
  input.commands = std::move(commands);
  input.last = last;
  ++k;
  return session.step(input);
}

StepAnswer Conversation::finish() {
  StepAnswer answer = step({good_frame()}, {}, true);
  session.finish();
  return answer;
}

int spare_domain() {
  // The ports of domains from 215 on are above Linux's ephemeral ports.
  constexpr int kFirst = 215;
  constexpr int kCount = static_cast<int>(hal::dds::kMaxDomain) - kFirst + 1;
  static std::set<int> ours;
  for (int attempt = 0; attempt < 600; ++attempt) {
    for (const int domain : ours)
      if (is_free(domain)) return domain;
    for (int domain = kFirst; domain < kFirst + kCount; ++domain) {
      if (ours.count(domain) > 0 || !reserve(domain)) continue;
      ours.insert(domain);
      if (is_free(domain)) return domain;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  throw SilFailure("no spare DDS domain: other tests have reserved all");
}

void leave_announcement_of_killed_run(int domain) {
  const pid_t child = fork();
  if (child == 0) {
    hal::dds::RunSecret secret;
    const bool is_made = hal::dds::make_run_secret(secret);
    const RunAnnouncement announcement(static_cast<std::uint32_t>(domain), secret);
    _exit(is_made ? 0 : 1);
  }
  int status = -1;
  const bool has_ended = child > 0 && waitpid(child, &status, 0) == child && status == 0;
  const fs::path file = RuntimeFolder().path_of("domain-" + std::to_string(domain) + ".run");
  std::error_code none;
  if (!has_ended || fs::file_size(file, none) == 0 || none)
    throw SilFailure("no announcement of a killed run");
}

Environment::Environment(const char* name, const std::string& value) : name_(name) {
  if (const char* before = std::getenv(name)) before_ = before;
  setenv(name, value.c_str(), 1);
}

Environment::~Environment() {
  before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_);
}

pid_t flight_child() {
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
    const pid_t pid = static_cast<pid_t>(std::atol(entry.path().filename().c_str()));
    if (pid > 0 && parent_of(pid) == getpid() && read_file(entry.path() / "comm") == "flight\n") return pid;
  }
  return 0;
}

}  // namespace tumblesight::sim::test

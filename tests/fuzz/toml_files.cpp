// Missions and campaigns of any text: read, or refused with the file's name. The lowest bit of the first byte
// tells which of them the rest is.
#include <sys/mman.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

#include "sim/campaign/campaign_file.hpp"
#include "sim/mission/mission.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {
namespace {

constexpr std::size_t kMostOfAMessage = 2000;

// In memory, as a file that is read by its name.
class File {
 public:
  File() { require(file_ >= 0, "a file can be made"); }
  ~File() { close(file_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  const std::string& path() const { return path_; }
  void fill(const std::string& text) const {
    require(ftruncate(file_, 0) == 0, "the file can be emptied");
    require(pwrite(file_, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()),
            "the file takes all bytes");
  }

 private:
  int file_ = memfd_create("toml", MFD_CLOEXEC);
  std::string path_ = "/proc/self/fd/" + std::to_string(file_);
};

void read_mission(const std::string& text) {
  const sim::Mission mission = sim::mission_from_toml(text, "any.toml", {"nominal", "degraded"});
  require(!mission.name.empty() && mission.name.size() < 32, "a mission's name is that of a target");
  require(mission.minutes >= 0.5 && mission.minutes <= 10'000.0, "minutes are within their limits");
  for (const auto& [name, weight] : mission.conditions)
    require(weight > 0 && weight <= 100, "a weight is within its limits");
}

void read_campaign(const std::string& path) {
  const sim::Campaign campaign = sim::read_campaign(path);
  require(!campaign.runs.empty() && campaign.runs.size() <= 1000, "a campaign has runs, and not too many");
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight::fuzz;
  static const File file;
  Input input(data, size);
  const bool is_mission = (input.u8() & 1) != 0;
  const std::string name = is_mission ? "any.toml" : file.path();
  try {
    if (is_mission) {
      read_mission(input.text());
    } else {
      file.fill(input.text());
      read_campaign(file.path());
    }
  } catch (const std::runtime_error& error) {
    require(std::string(error.what()).find(name) != std::string::npos, "a refusal names the file");
    require(std::string(error.what()).size() < kMostOfAMessage, "a refusal is short");
  } catch (const std::invalid_argument& error) {
    require(std::string(error.what()).find(name) != std::string::npos, "a refusal names the file");
    require(std::string(error.what()).size() < kMostOfAMessage, "a refusal is short");
  }
  return 0;
}

#include "tests/campaigns/fault/campaign.hpp"

#include <sys/mman.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "gnc/rcnn/model_image.hpp"
#include "sim/world/frame_renderer.hpp"
#include "sim/world/target/targets.hpp"
#include "tests/campaigns/fault/trial.hpp"

namespace tumblesight::fault {
namespace {

// Differs from the simulator's rule. It must not change, because the results in docs/faults.md were made with
// it.
std::uint64_t noise_seed_of_campaign(const sim::Sequence& sequence, std::uint32_t frame) {
  return sequence.noise_seed + frame;
}

// Processor time of one trial, which takes milliseconds. By the clock on the wall a busy machine would hang.
constexpr itimerval kHang{{0, 0}, {20, 0}};

// The results of a child process, which remain even if it dies.
struct Shared {
  std::uint32_t done = 0;
  Trial trials[1];  // as many as requested
};

class SharedTrials {
 public:
  explicit SharedTrials(std::uint32_t count) : size_(sizeof(Shared) + count * sizeof(Trial)) {
    void* memory = mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("no memory for the trials");
    shared_ = new (memory) Shared;
  }
  ~SharedTrials() { munmap(shared_, size_); }
  SharedTrials(const SharedTrials&) = delete;
  SharedTrials& operator=(const SharedTrials&) = delete;
  Shared* operator->() { return shared_; }

 private:
  std::size_t size_;
  Shared* shared_;
};

}  // namespace

const char* to_string(Place place) {
  constexpr const char* kNames[] = {"weights",          "activations", "estimator state", "application state",
                                    "model descriptor", "command",     "frame",           "two at a time",
                                    "surface"};
  return kNames[static_cast<int>(place)];
}

const char* to_string(Outcome outcome) {
  constexpr const char* kNames[] = {"masked",     "recovered", "safe", "flagged wrong", "silent wrong",
                                    "lost count", "crash",     "hang", "unprotected",   "wrong pose"};
  return kNames[static_cast<int>(outcome)];
}

Flight make_flight(const std::string& target, const std::string& model_path, int sequences,
                   std::uint64_t seed) {
  Flight flight;
  flight.target = target;
  std::ifstream file(model_path, std::ios::binary);
  flight.model.assign(std::istreambuf_iterator<char>(file), {});
  gnc::ModelHeader header;
  static gnc::NetworkWeights<gnc::FixedPoint> weights;
  const gnc::ModelStatus status = gnc::read_model_image<gnc::FixedPoint>(
      flight.model.data(), flight.model.size(), target.c_str(), header, weights);
  if (status != gnc::ModelStatus::kOk) throw std::runtime_error(model_path + ": " + gnc::to_string(status));
  const sim::FlashLidar lidar(sim::target_by_name(target));
  const sim::FrameRenderer renderer(lidar, 1e-3 * header.projection.swath_mm, noise_seed_of_campaign);
  for (int i = 0; i < sequences; ++i) {
    const sim::Sequence sequence = sim::make_sequence({}, seed, static_cast<std::uint64_t>(i));
    for (std::size_t k = 0; k < sequence.frames.size(); ++k) {
      flight.truth.push_back(sequence.frames[k]);
      flight.frames.emplace_back();
      renderer.render(sequence, static_cast<std::uint32_t>(k), flight.frames.back());
    }
  }
  return flight;
}

std::vector<Trial> run_trials(const Flight& flight, Place place, bool with_protections, std::uint64_t seed,
                              std::uint32_t first, std::uint32_t count) {
  const auto runner = std::make_unique<TrialRunner>(flight, with_protections, place == Place::kActivations);
  SharedTrials shared(count);
  while (shared->done < count) {
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no process for the trials");
    if (child == 0) {
      while (shared->done < count) {
        setitimer(ITIMER_PROF, &kHang, nullptr);
        shared->trials[shared->done] = runner->run(place, seed, first + shared->done);
        ++shared->done;
      }
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) {
      const bool hung = WTERMSIG(status) == SIGPROF;
      shared->trials[shared->done++].outcome = hung ? Outcome::kHang : Outcome::kCrash;
    }
  }
  return {shared->trials, shared->trials + count};
}

}  // namespace tumblesight::fault

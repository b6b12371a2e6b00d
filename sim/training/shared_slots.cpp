#include "sim/training/shared_slots.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <utility>

namespace tumblesight::sim {
namespace {

constexpr mode_t kOwnerOnly = 0600;
constexpr int kTurns = 2;

// How often a rank has come. A cache line each.
struct alignas(64) Arrival {
  std::atomic<std::uint32_t> meetings;
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free, "processes share it");

struct flock lock_of(int rank, short type) {
  struct flock lock {};
  lock.l_type = type;
  lock.l_whence = SEEK_SET;
  lock.l_start = rank;
  lock.l_len = 1;
  return lock;
}

}  // namespace

std::unique_ptr<SharedSlots> SharedSlots::create(const std::string& name, int ranks, std::int64_t size) {
  const int file = shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL, kOwnerOnly);
  if (file < 0) return nullptr;
  std::unique_ptr<SharedSlots> slots(new SharedSlots(file, 0, ranks, size));
  // Reserves the memory: without, a full file system would end the process at its first write.
  if (posix_fallocate(file, 0, static_cast<off_t>(slots->bytes())) == 0 && slots->map()) return slots;
  forget(name);
  return nullptr;
}

std::unique_ptr<SharedSlots> SharedSlots::open(const std::string& name, int rank, int ranks,
                                               std::int64_t size) {
  const int file = shm_open(name.c_str(), O_RDWR, 0);
  if (file < 0) return nullptr;
  std::unique_ptr<SharedSlots> slots(new SharedSlots(file, rank, ranks, size));
  return slots->map() ? std::move(slots) : nullptr;
}

void SharedSlots::forget(const std::string& name) {
  shm_unlink(name.c_str());
}

SharedSlots::SharedSlots(int file, int rank, int ranks, std::int64_t size)
    : file_(file), rank_(rank), ranks_(ranks), size_(size) {}

SharedSlots::~SharedSlots() {
  if (memory_ != nullptr) munmap(memory_, bytes());
  close(file_);
}

std::size_t SharedSlots::bytes() const {
  return static_cast<std::size_t>(ranks_) *
         (sizeof(Arrival) + kTurns * static_cast<std::size_t>(size_) * sizeof(float));
}

// The lock tells the other ranks that this one lives: the system releases it however the process ends.
bool SharedSlots::map() {
  struct flock lock = lock_of(rank_, F_WRLCK);
  if (fcntl(file_, F_OFD_SETLK, &lock) != 0) return false;
  void* const memory = mmap(nullptr, bytes(), PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (memory != MAP_FAILED) memory_ = memory;
  return memory_ != nullptr;
}

torch::Tensor SharedSlots::slot(int rank, std::int64_t size) const {
  auto* const slots = reinterpret_cast<float*>(static_cast<Arrival*>(memory_) + ranks_);
  return torch::from_blob(slots + (turn_ * ranks_ + rank) * size_, {size}, torch::kFloat);
}

void SharedSlots::meet(std::chrono::milliseconds timeout) {
  ++meetings_;
  static_cast<Arrival*>(memory_)[rank_].meetings.store(meetings_, std::memory_order_release);
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  // The others are mostly there within microseconds. Then the core is left to the rendering threads.
  constexpr int kLooksInARow = 1'000, kLooksPerCheck = 2'000;
  constexpr auto kBetweenLooks = std::chrono::microseconds(20);
  for (int look = 1; first_missing() < ranks_; ++look) {
    if (look < kLooksInARow) continue;
    std::this_thread::sleep_for(kBetweenLooks);
    if (look % kLooksPerCheck != 0) continue;
    require_living();
    const int missing = first_missing();
    if (missing < ranks_ && std::chrono::steady_clock::now() > deadline)
      throw std::runtime_error("rank " + std::to_string(missing) + " does not answer");
  }
}

// The number of ranks: none is missing.
int SharedSlots::first_missing() const {
  int rank = 0;
  while (rank < ranks_ && has_arrived(rank)) ++rank;
  return rank;
}

// Throws if a rank has ended instead of coming.
void SharedSlots::require_living() const {
  for (int rank = 0; rank < ranks_; ++rank) {
    if (has_arrived(rank) || is_alive(rank) || has_arrived(rank)) continue;  // it may have come and ended
    throw std::runtime_error("rank " + std::to_string(rank) + " has ended");
  }
}

// It may have come to the next meeting already.
bool SharedSlots::has_arrived(int rank) const {
  const std::uint32_t meetings =
      static_cast<Arrival*>(memory_)[rank].meetings.load(std::memory_order_acquire);
  return static_cast<std::int32_t>(meetings - meetings_) >= 0;
}

bool SharedSlots::is_alive(int rank) const {
  struct flock lock = lock_of(rank, F_WRLCK);
  return rank == rank_ || (fcntl(file_, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK);
}

}  // namespace tumblesight::sim

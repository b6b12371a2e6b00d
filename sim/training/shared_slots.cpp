#include "sim/training/shared_slots.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace tumblesight::sim {
namespace {

constexpr mode_t kOwnerOnly = 0600;

std::size_t bytes_of(int count, std::int64_t size) {
  return static_cast<std::size_t>(count) * static_cast<std::size_t>(size) * sizeof(float);
}

}  // namespace

std::unique_ptr<SharedSlots> SharedSlots::create(const std::string& name, int count, std::int64_t size) {
  const int file = shm_open(name.c_str(), O_RDWR | O_CREAT | O_EXCL, kOwnerOnly);
  if (file < 0) return nullptr;
  std::unique_ptr<SharedSlots> slots;
  // Reserves the memory: without, a full file system would end the process at its first write.
  if (posix_fallocate(file, 0, static_cast<off_t>(bytes_of(count, size))) == 0)
    slots.reset(new SharedSlots(file, count, size));
  close(file);
  if (!slots || slots->memory_ == nullptr) {
    forget(name);
    return nullptr;
  }
  return slots;
}

std::unique_ptr<SharedSlots> SharedSlots::open(const std::string& name, int count, std::int64_t size) {
  const int file = shm_open(name.c_str(), O_RDWR, 0);
  if (file < 0) return nullptr;
  std::unique_ptr<SharedSlots> slots(new SharedSlots(file, count, size));
  close(file);
  return slots->memory_ == nullptr ? nullptr : std::move(slots);
}

void SharedSlots::forget(const std::string& name) {
  shm_unlink(name.c_str());
}

SharedSlots::SharedSlots(int file, int count, std::int64_t size) : count_(count), size_(size) {
  void* const memory = mmap(nullptr, bytes_of(count, size), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (memory != MAP_FAILED) memory_ = static_cast<float*>(memory);
}

SharedSlots::~SharedSlots() {
  if (memory_ != nullptr) munmap(memory_, bytes_of(count_, size_));
}

torch::Tensor SharedSlots::slot(int index, std::int64_t size) const {
  return torch::from_blob(memory_ + index * size_, {size}, torch::kFloat);
}

}  // namespace tumblesight::sim

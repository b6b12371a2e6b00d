// Assertions of the flight application: they stand for bugs in our code, never for bad input. A failed one is
// recorded; the application sees the record and goes SAFE. Nothing is aborted.
#pragma once

#include <cstdint>

namespace tumblesight::fsw {

// FNV-1a of the file's name without its folders, so that an event names a source file in 32 bits and every
// build agrees.
constexpr std::uint32_t file_id(const char* path) {
  const char* name = path;
  for (const char* c = path; *c != '\0'; ++c) {
    if (*c == '/') name = c + 1;
  }
  std::uint32_t hash = 2'166'136'261U;
  for (; *name != '\0'; ++name) hash = (hash ^ static_cast<std::uint8_t>(*name)) * 16'777'619U;
  return hash;
}

class AssertionLog {
 public:
  // Keeps the first failure not yet taken: what follows it is mostly its consequence. Always returns false.
  bool record(std::uint32_t file, std::int32_t line) {
    if (count_ < UINT32_MAX) ++count_;
    if (!pending_) {
      file_ = file;
      line_ = line;
    }
    pending_ = true;
    return false;
  }
  // True once a failure: then file(), line() tell where.
  bool take() {
    const bool was_pending = pending_;
    pending_ = false;
    return was_pending;
  }
  bool pending() const { return pending_; }
  std::uint32_t file() const { return file_; }
  std::int32_t line() const { return line_; }
  std::uint32_t count() const { return count_; }  // since start

 private:
  std::uint32_t file_ = 0;
  std::int32_t line_ = 0;
  std::uint32_t count_ = 0;
  bool pending_ = false;
};

}  // namespace tumblesight::fsw

// An expression: false when the condition does not hold, so that the caller can leave instead of going on.
#define TUMBLESIGHT_ASSERT(log, condition) \
  ((condition) ? true : (log).record(::tumblesight::fsw::file_id(__FILE__), __LINE__))

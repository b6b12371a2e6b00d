// Assertions of the flight application. They detect bugs in the flight software, never bad input. A failed
// assertion is recorded, and the application goes SAFE at the next check of the log. Nothing is aborted.
#pragma once

#include <cstdint>

namespace tumblesight::fsw {

// FNV-1a hash of the file name without its folders: 32 bits that name a source file in an event, the same in
// every build.
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
  // Keeps the first failure since the last take(), because later ones are often its consequence. Always
  // returns false.
  bool record(std::uint32_t file, std::int32_t line) {
    if (count_ < UINT32_MAX) ++count_;
    if (!pending_) {
      file_ = file;
      line_ = line;
    }
    pending_ = true;
    return false;
  }
  // True once after a failure; file() and line() are its place.
  bool take() {
    const bool was_pending = pending_;
    pending_ = false;
    return was_pending;
  }
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

// An expression with the value of `condition`, so that the caller can stop where it is false.
#define TUMBLESIGHT_ASSERT(log, condition) \
  ((condition) ? true : (log).record(::tumblesight::fsw::file_id(__FILE__), __LINE__))

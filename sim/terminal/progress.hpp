// ProgressBar: how far a long job is, how fast it goes and how long it still takes.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace tumblesight::sim {

// Rewrites one line in place on a terminal; elsewhere (a log file) prints at most a line a tenth of the
// way and a second.
class ProgressBar {
 public:
  // `unit` in the plural: "frames".
  ProgressBar(std::string label, std::string unit, std::uint64_t total, std::FILE* stream = stderr);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(std::uint64_t done);  // not thread-safe
  void finish();                    // leaves the last line standing; update() after it has no effect

 private:
  void print(std::uint64_t done, double elapsed_s);

  std::string label_;
  std::string unit_;
  std::uint64_t total_;
  std::FILE* stream_;
  bool in_place_;
  bool finished_ = false;
  std::uint64_t done_ = 0;
  std::uint64_t printed_tenth_ = 0;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point printed_;
};

// The line itself, for `done` of `total` after `elapsed_s`; with a bar of `bar_columns` characters (0: none).
std::string progress_line(const std::string& label, const std::string& unit, std::uint64_t done,
                          std::uint64_t total, double elapsed_s, int bar_columns);

}  // namespace tumblesight::sim

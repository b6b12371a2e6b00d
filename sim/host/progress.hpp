// ProgressBar: progress, rate and remaining time of a long job.
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>

namespace tumblesight::sim {

// On a terminal it rewrites one line in place. Elsewhere (a log file) it prints a line for every tenth of the
// job and after every half minute, but at most one per second.
class ProgressBar {
 public:
  // `unit` in the plural: "frames". `done_before`: what an earlier run of the same job had done, for a
  // correct rate.
  ProgressBar(std::string label, std::string unit, std::uint64_t total, std::FILE* stream = stderr,
              std::uint64_t done_before = 0);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // `note` is shown at the end of the line. Not thread-safe.
  void update(std::uint64_t done, const std::string& note = {});
  // Keeps the last line; update() has no effect afterwards.
  void finish();

 private:
  void print(std::uint64_t done, double elapsed_s);

  std::string label_;
  std::string unit_;
  std::uint64_t total_;
  std::FILE* stream_;
  bool in_place_;
  bool finished_ = false;
  std::uint64_t done_before_;
  std::uint64_t done_;
  std::string note_;
  std::uint64_t printed_tenth_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point printed_;
};

// The text of the line for `done` of `total`. `elapsed_s`: time since the first `done_before` were done.
// `bar_columns`: characters of the bar (0: no bar).
std::string progress_line(const std::string& label, const std::string& unit, std::uint64_t done,
                          std::uint64_t total, double elapsed_s, int bar_columns,
                          std::uint64_t done_before = 0);

}  // namespace tumblesight::sim

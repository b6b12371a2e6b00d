#include "sim/host/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

namespace tumblesight::sim {
namespace {

constexpr std::chrono::milliseconds kRedraw{100};
constexpr std::chrono::seconds kMinLineInterval{1};
constexpr std::chrono::seconds kMaxLineInterval{30};
constexpr int kBarColumns = 30;

std::string duration_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(seconds + 0.5);
  if (whole >= 3600) return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
  if (whole >= 60) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} s", whole);
}

std::string bar_text(double share, int columns) {
  const int full = static_cast<int>(share * columns);
  std::string bar;
  for (int i = 0; i < columns; ++i) bar += i < full ? "━" : "─";
  return bar + "  ";
}

}  // namespace

std::string progress_line(const std::string& label, const std::string& unit, std::uint64_t done,
                          std::uint64_t total, double elapsed_s, int bar_columns, std::uint64_t done_before) {
  const double share =
      total == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
  std::string line = fmt::format("  {}  {}{:3.0f} %  {}/{} {}", label,
                                 bar_columns > 0 ? bar_text(share, bar_columns) : std::string{},
                                 100.0 * share, done, total, unit);
  if (done <= done_before || elapsed_s <= 0.0) return line;
  const double rate_hz = static_cast<double>(done - done_before) / elapsed_s;
  line += fmt::format("  {:.{}f}/s", rate_hz, rate_hz < 10.0 ? 1 : 0);
  if (done >= total) return line + fmt::format("  took {}", duration_text(elapsed_s));
  return line + fmt::format("  {} left", duration_text(static_cast<double>(total - done) / rate_hz));
}

ProgressBar::ProgressBar(std::string label, std::string unit, std::uint64_t total, std::FILE* stream,
                         std::uint64_t done_before)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      total_(total),
      stream_(stream),
      in_place_(isatty(fileno(stream)) == 1),
      done_before_(done_before),
      done_(done_before),
      printed_tenth_(total == 0 ? 10 : 10 * done_before / total),
      start_(std::chrono::steady_clock::now()),
      printed_(in_place_ ? start_ - kRedraw : start_) {}

ProgressBar::~ProgressBar() {
  finish();
}

void ProgressBar::update(std::uint64_t done, const std::string& note) {
  if (finished_) return;
  done_ = done;
  note_ = note;
  const auto now = std::chrono::steady_clock::now();
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  if (in_place_) {
    if (now - printed_ < kRedraw && done < total_) return;
    printed_ = now;
    print(done, elapsed_s);
    return;
  }
  const std::uint64_t tenth = total_ == 0 ? 10 : 10 * done / total_;
  const auto since_last = now - printed_;
  const bool due = (tenth > printed_tenth_ && (since_last >= kMinLineInterval || done >= total_)) ||
                   since_last >= kMaxLineInterval;
  if (!due) return;
  printed_tenth_ = tenth;
  printed_ = now;
  print(done, elapsed_s);
}

void ProgressBar::print(std::uint64_t done, double elapsed_s) {
  std::string line =
      progress_line(label_, unit_, done, total_, elapsed_s, in_place_ ? kBarColumns : 0, done_before_);
  if (!note_.empty()) line += "  " + note_;
  if (in_place_) {
    std::fprintf(stream_, "\r%s\x1b[K", line.c_str());
  } else {
    std::fprintf(stream_, "%s\n", line.c_str());
  }
  std::fflush(stream_);
}

void ProgressBar::finish() {
  if (finished_) return;
  finished_ = true;
  if (!in_place_) return;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  print(done_, elapsed.count());
  std::fputc('\n', stream_);
}

}  // namespace tumblesight::sim

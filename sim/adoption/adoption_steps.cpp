#include "sim/adoption/adoption_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "sim/report/page.hpp"
#include "sim/report/svg.hpp"

namespace tumblesight::sim {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kRenewal_s = 5;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string row_of(const AdoptionStep& step) {
  const char* state = step.state == StepState::kDone      ? "done"
                      : step.state == StepState::kRunning ? "<b>running</b>"
                                                          : "";
  return fmt::format(
      "<tr><td>{}</td><td>{}</td><td class=number>{}</td><td class=number>{}</td><td>{}</td></tr>\n",
      escape_markup(step.name), state, step.taken_s > 0.0 ? duration_text(step.taken_s) : "",
      step.planned_s > 0.0 ? duration_text(step.planned_s) : "", escape_markup(step.result));
}

// The validation error of the training so far, as the training draws it.
std::string curve_of(const std::string& folder) {
  std::ifstream in(folder + "/training/curve.svg");
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(std::max(0.0, seconds)));
  if (whole < 90) return fmt::format("{} s", whole);
  const long minutes = (whole + 30) / 60;
  if (minutes < 60) return fmt::format("{} min", minutes);
  return fmt::format("{} h {} min", minutes / 60, minutes % 60);
}

AdoptionSteps::AdoptionSteps(std::string title, std::string folder, double budget_s, double taken_s)
    : title_(std::move(title)),
      folder_(std::move(folder)),
      budget_s_(budget_s),
      taken_before_s_(taken_s),
      start_(Clock::now()),
      step_start_(start_) {}

double AdoptionSteps::elapsed_s() const {
  return taken_before_s_ + seconds_since(start_);
}

double AdoptionSteps::left_s() const {
  return std::max(0.0, budget_s_ - elapsed_s());
}

AdoptionStep* AdoptionSteps::running() {
  const auto found = std::find_if(steps_.begin(), steps_.end(),
                                  [](const AdoptionStep& step) { return step.state == StepState::kRunning; });
  return found == steps_.end() ? nullptr : &*found;
}

void AdoptionSteps::plan(const std::string& name, double seconds) {
  for (AdoptionStep& step : steps_) {
    if (step.name == name) {
      step.planned_s = seconds;
      return;
    }
  }
  steps_.push_back({name, seconds, 0.0, StepState::kPlanned, {}});
}

void AdoptionSteps::begin(const std::string& name) {
  if (AdoptionStep* last = running()) {
    last->taken_s = seconds_since(step_start_);
    last->state = StepState::kDone;
  }
  const auto next = std::find_if(steps_.begin(), steps_.end(),
                                 [&name](const AdoptionStep& step) { return step.name == name; });
  next->state = StepState::kRunning;
  const auto number = next - steps_.begin() + 1;
  step_start_ = Clock::now();
  fmt::print("\n  Step {} of {}: {}  ({} of {} left)\n", number, steps_.size(), name, duration_text(left_s()),
             duration_text(budget_s_));
  std::fflush(stdout);
  write_page(true);
}

void AdoptionSteps::say(const std::string& result) {
  if (AdoptionStep* step = running()) {
    step->result = result;
    step->taken_s = seconds_since(step_start_);
  }
  write_page(true);
}

void AdoptionSteps::remark(const std::string& text) {
  remarks_.push_back(text);
  write_page(true);
}

void AdoptionSteps::finish(const std::string& ending) {
  if (AdoptionStep* last = running()) {
    last->taken_s = seconds_since(step_start_);
    last->state = StepState::kDone;
  }
  ending_ = ending;
  write_page(false);
}

void AdoptionSteps::write_page(bool renews) const {
  std::string body = renews ? fmt::format("<meta http-equiv=refresh content={}>\n", kRenewal_s) : "";
  body += fmt::format("<h1>Adoption of {}</h1>\n<p class=lead>{}</p>\n", escape_markup(title_),
                      renews ? fmt::format("{} of {} left", duration_text(left_s()), duration_text(budget_s_))
                             : escape_markup(ending_));
  body += html_notices({}, remarks_);
  body +=
      "<table><tr><th>step</th><th></th><th class=number>time</th><th "
      "class=number>planned</th><th></th></tr>\n";
  for (const AdoptionStep& step : steps_) body += row_of(step);
  body += "</table>\n<div class=pair>" + html_figure("Validation error", curve_of(folder_), "") + "</div>\n";
  if (!renews) body += "<p><a href=report.html>Report</a></p>\n";
  write_file(folder_ + "/progress.html", html_page("adoption", body + html_footer(local_time_text(), "")));
}

}  // namespace tumblesight::sim

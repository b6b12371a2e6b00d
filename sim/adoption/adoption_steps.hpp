// AdoptionSteps: the steps of an adoption, with their times, for the terminal and for a page that renews
// itself.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace tumblesight::sim {

enum class StepState { kPlanned, kRunning, kDone };

struct AdoptionStep {
  std::string name;
  double planned_s = 0.0;
  double taken_s = 0.0;
  StepState state = StepState::kPlanned;
  std::string result;  // in words, once it is known
};

class AdoptionSteps {
 public:
  // `folder`: of progress.html. `budget_s`: for everything. `taken_s`: by an earlier run that this one goes
  // on.
  AdoptionSteps(std::string title, std::string folder, double budget_s, double taken_s);

  void plan(const std::string& name, double seconds);
  // Ends the running step, if there is one, and begins this one, which was planned. Prints a line.
  void begin(const std::string& name);
  void say(const std::string& result);     // of the running step; renews the page
  void remark(const std::string& text);    // stands on the page from now on
  void finish(const std::string& ending);  // the last words on the page; no renewal any more

  double elapsed_s() const;  // of everything, with the earlier run
  double left_s() const;     // of the budget, at least 0
  const std::vector<AdoptionStep>& steps() const { return steps_; }

 private:
  AdoptionStep* running();
  void write_page(bool renews) const;

  std::string title_, folder_, ending_;
  double budget_s_, taken_before_s_;
  std::vector<AdoptionStep> steps_;
  std::vector<std::string> remarks_;
  std::chrono::steady_clock::time_point start_, step_start_;
};

// "41 min", "1 h 12 min", "25 s".
std::string duration_text(double seconds);

}  // namespace tumblesight::sim

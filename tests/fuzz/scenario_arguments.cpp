// Options of a scenario, from the words of the command line to their use: numbers within their limits,
// conditions, the report's file name, the settings of an experiment, an inertia and the tumbling motion with
// it.
#include <CLI/CLI.hpp>
#include <cmath>

#include "sim/cli/evaluate_arguments.hpp"
#include "sim/cli/simulate_arguments.hpp"
#include "sim/cli/target_setup.hpp"
#include "tests/fuzz/arguments.hpp"

namespace tumblesight::fuzz {
namespace {

constexpr std::size_t kLongestFileName = 255;

struct Given {
  sim::EvaluateArguments evaluate;
  std::string speed = "max";
};

// The options are made once for many command lines. The values are reset for each.
bool parse(CommandLine& line, Given& given) {
  static Reused reused([&given] {
    auto app = std::make_unique<CLI::App>();
    sim::Command command(*app);
    sim::add_evaluate_options(command, given.evaluate);
    command.add_option("--speed", given.speed)->check(sim::number(0.1, 1000.0));
    return app;
  });
  CLI::App& app = reused.get();
  given = {};
  try {
    app.parse(line.argc(), line.argv());
    sim::require_supported_length(given.evaluate.scenario);
    sim::require_separate_files(sim::files_read(given.evaluate.scenario),
                                sim::files_written(given.evaluate.files));
    if (given.evaluate.paper) sim::refuse_options_set_by_paper(sim::Command(app));
    return true;
  } catch (const CLI::ParseError&) {
    return false;
  } catch (const sim::ArgumentFault&) {
    return false;
  } catch (const sim::Exit&) {  // --effect list
    return false;
  }
}

template <class Number>
void check_within(Number low, Number value, Number high) {
  require(value >= low && value <= high, "a number that was accepted is within its limits");
}

void check_numbers(const Given& given) {
  const sim::ScenarioArguments& scenario = given.evaluate.scenario;
  check_within<std::uint32_t>(1, scenario.sequences, 10'000'000);
  check_within<std::uint32_t>(1, scenario.frames, 1000);
  check_within<std::uint32_t>(1, given.evaluate.baseline_sequences, 100'000);
  check_within(0, given.evaluate.threads, 1024);
  check_within(1e-6, scenario.mesh_scale, 1e6);
  if (given.speed != "max") check_within(0.1, std::stod(given.speed), 1000.0);
  require(!scenario.target.empty() && scenario.target.size() < 32, "a target's name fits the model image");
}

void check_report_name(const Given& given) {
  sim::SimulateArguments arguments;
  arguments.scenario = given.evaluate.scenario;
  arguments.scenario.condition = given.evaluate.conditions.front();
  arguments.flight = given.evaluate.mesh_folder;  // any path
  arguments.speed = given.speed;
  const std::string name = sim::default_report_name(arguments);
  require(name.size() <= kLongestFileName, "a report's name is short enough for a file");
  require(name.find('/') == std::string::npos, "a report's name is not a path");
}

// Whether set_up_target() accepts the inertia. If so, it continues to the model, which is missing.
bool is_accepted(sim::ScenarioArguments scenario) {
  scenario.mesh.clear();
  scenario.model = "/dev/null/none";
  try {
    (void)sim::set_up_target(scenario);
  } catch (const std::invalid_argument&) {
    return false;
  } catch (const std::runtime_error&) {
    return true;
  }
  return true;
}

void check_tumbling(const sim::ScenarioArguments& scenario, sim::Condition condition) {
  const std::vector<double>& i = scenario.inertia;
  sim::ScenarioSettings settings;
  settings.condition = condition;
  settings.inertia_kg_m2 << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  try {
    for (const sim::FrameTruth& frame : sim::make_sequence(settings, scenario.seed, 0).frames) {
      require(std::abs(frame.q_lrf_trf.norm() - 1.0) < 1e-9,
              "a tumbling body's attitude is a unit quaternion");
      require(frame.rate_lrf_rad_s.allFinite(), "a tumbling body's rate is finite");
    }
  } catch (const std::invalid_argument&) {
  }
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  using namespace tumblesight::fuzz;
  CommandLine line(Input(data, size));
  static Given given;
  if (!parse(line, given)) return 0;
  check_numbers(given);
  check_report_name(given);
  require(sim::steps_of(sim::experiment_settings(given.evaluate)) > 0, "there is something to do");
  const sim::ScenarioArguments& scenario = given.evaluate.scenario;
  if (scenario.inertia.empty() || !is_accepted(scenario)) return 0;
  check_tumbling(scenario, sim::Condition::kTumbling);
  check_tumbling(scenario, sim::Condition::kStress);
  return 0;
}

#include "sim/adoption/adoption_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "sim/inspection/six_views.hpp"
#include "sim/report/charts.hpp"
#include "sim/report/colours.hpp"
#include "sim/report/error_json.hpp"
#include "sim/report/mesh_report.hpp"
#include "sim/report/page.hpp"
#include "sim/report/results_files.hpp"
#include "sim/report/results_json.hpp"
#include "sim/report/results_tables.hpp"
#include "sim/report/svg.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPagePixels = 256;

Results results_of(const AdoptionSettings& settings, const AdoptionOutcome& outcome) {
  Results results;
  results.seed = settings.seed;
  results.command = settings.command;
  results.generated = local_time_text();
  results.subjects.push_back(outcome.result);
  return results;
}

Json checks_json(const std::vector<GoalCheck>& checks) {
  Json json = Json::array();
  for (const GoalCheck& check : checks)
    json.push_back({{"condition", to_string(check.condition)},
                    {"figure", check.figure},
                    {"asked", check.limit},
                    {"found", check.value},
                    {"met", check.met}});
  return json;
}

Json steps_json(const std::vector<AdoptionStep>& steps) {
  Json json = Json::array();
  for (const AdoptionStep& step : steps)
    json.push_back(
        {{"step", step.name}, {"seconds", std::round(10.0 * step.taken_s) / 10.0}, {"result", step.result}});
  return json;
}

Json joints_json(const AdoptionOutcome& outcome) {
  Json json = Json::array();
  for (std::size_t i = 0; i < outcome.joint_cells.size(); ++i)
    json.push_back({{"panel_turn_deg", outcome.joint_angles_deg[i]},
                    {"rcnn", summary_json(outcome.joint_cells[i].rcnn)},
                    {"pose", pose_json(outcome.joint_cells[i].pose)}});
  return json;
}

std::string list_of(const std::string& heading, const std::vector<std::string>& lines) {
  if (lines.empty()) return {};
  std::string text = "<h2>" + heading + "</h2>\n<ul>\n";
  for (const std::string& line : lines) text += "<li>" + escape_markup(line) + "</li>\n";
  return text + "</ul>\n";
}

DataTable goals_table(const std::vector<GoalCheck>& checks) {
  DataTable table{{"goal", "asked", "found"}, {}};
  for (const GoalCheck& check : checks)
    table.rows.push_back({{to_string(check.condition) + ": " + check.figure},
                          {check.limit},
                          {check.value, check.met ? Mark::kMet : Mark::kMissed}});
  return table;
}

DataTable times_table(const std::vector<AdoptionStep>& steps) {
  DataTable table{{"step", "time", "result"}, {}};
  for (const AdoptionStep& step : steps)
    if (step.state == StepState::kDone)
      table.rows.push_back(
          {{step.name}, {duration_text(step.taken_s)}, {step.result.empty() ? "-" : step.result}});
  return table;
}

// Mean error of network and registered pose over the angle of the panels.
std::string joints_figure(const AdoptionOutcome& outcome) {
  if (outcome.joint_cells.empty()) return {};
  Series network{"network", kRcnnColour, "", {}}, pose{"registered pose", kCnnColour, "", {}};
  LineChart chart;
  chart.description = "Mean error over the angle of the panels";
  chart.x_label = "angle of the panels from the mesh [deg]";
  chart.y_label = "mean error [deg]";
  double high = 1.0;
  const auto add = [&](double angle_deg, const CellResult& cell) {
    network.points.push_back({angle_deg, cell.rcnn.mean_deg});
    if (cell.pose.known > 0.0) pose.points.push_back({angle_deg, cell.pose.mean_deg});
    high = std::max({high, cell.rcnn.mean_deg, cell.pose.known > 0.0 ? cell.pose.mean_deg : 0.0});
  };
  bool zero = false;
  for (std::size_t i = 0; i < outcome.joint_cells.size(); ++i) {
    const bool past_zero = outcome.joint_angles_deg[i] > 0.0;
    if (past_zero && !zero && !outcome.result.cells.empty()) add(0.0, outcome.result.cells.front());
    zero = zero || past_zero;
    add(outcome.joint_angles_deg[i], outcome.joint_cells[i]);
  }
  chart.x_ticks = round_ticks(network.points.front().x, network.points.back().x, 6);
  chart.x_low = chart.x_ticks.front();
  chart.x_high = chart.x_ticks.back();
  chart.y_high = 1.1 * high;
  chart.series = {network, pose};
  return line_chart(chart);
}

std::string training_curve(const std::string& folder) {
  std::ifstream in(folder + "/training/curve.svg");
  return std::string{std::istreambuf_iterator<char>(in), {}};
}

std::string links(const AdoptionOutcome& outcome) {
  std::string text = "<p><a href=mesh.html>Mesh</a>";
  if (!outcome.result.cells.empty()) text += " · <a href=evaluation.html>Evaluation in full</a>";
  if (outcome.flight.well) text += " · <a href=flight.html>Flight over DDS</a>";
  return text + "</p>\n";
}

std::string lead(const AdoptionSettings& settings, const AdoptionOutcome& outcome) {
  const std::string name = escape_markup(settings.mission.title);
  if (outcome.go) return fmt::format("<b>GO.</b> The network for {} meets every goal of its mission.", name);
  if (outcome.model_path.empty())
    return fmt::format("<b>NO-GO.</b> No network was trained for {}: the mesh has to be mended first.", name);
  return fmt::format("<b>NO-GO.</b> The network for {} is not to be flown as it is.", name);
}

}  // namespace

Json verdict_json(const AdoptionSettings& settings, const AdoptionOutcome& outcome) {
  const Mission& mission = settings.mission;
  const bool trained = !outcome.model_path.empty();
  Json json{{"verdict", outcome.go ? "GO" : "NO-GO"}, {"reasons", outcome.reasons}};
  json["rows"] = trained ? results_json(results_of(settings, outcome)).at("rows") : Json::array();
  json["goals"] = checks_json(outcome.checks);
  json["outlook"] = outcome.outlook;
  json["remarks"] = outcome.remarks;
  json["joints"] = joints_json(outcome);
  json["mission"] = {{"name", mission.name},
                     {"file", mission.file},
                     {"crc32", fmt::format("{:08x}", mission_crc32(mission))}};
  json["model"] = trained ? Json{{"file", outcome.model_path},
                                 {"crc32", fmt::format("{:08x}", outcome.model_crc32)},
                                 {"start_from", outcome.start_from}}
                          : Json(nullptr);
  json["flight"] = {{"flown", outcome.flight.flown},
                    {"well", outcome.flight.well},
                    {"mostly_wrong", outcome.flight.wrong},
                    {"command", outcome.flight.command}};
  json["minutes_allowed"] = settings.minutes;
  json["minutes_taken"] = std::round(100.0 * outcome.minutes_taken) / 100.0;
  json["steps"] = steps_json(outcome.steps);
  json["command"] = settings.command;
  return json;
}

std::string adoption_page(const AdoptionSettings& settings, const AdoptionOutcome& outcome) {
  std::string body = fmt::format(
      "<h1>Adoption of {}</h1>\n<p class=sub>mission {}, {} of {} minutes used</p>\n<p class=lead>{}</p>\n",
      escape_markup(settings.mission.title),
      escape_markup(std::filesystem::path(settings.mission.file).filename().string()),
      fmt::format("{:.1f}", outcome.minutes_taken), settings.minutes, lead(settings, outcome));
  body += html_notices(outcome.reasons, {});
  body += links(outcome);
  if (!outcome.checks.empty()) body += "<h2>Goals</h2>\n" + html_text(goals_table(outcome.checks), "results");
  body += list_of("What more time would bring", outcome.outlook);
  if (!outcome.outlook.empty())
    body +=
        "<p class=sub>The course of the validation error, extrapolated as a power of the training "
        "time.</p>\n";
  const DataTable poses = poses_table(outcome.result);
  if (!poses.rows.empty()) body += "<h2>Registered pose</h2>\n" + html_text(transposed(poses), "poses");
  body += "<div class=pair>\n";
  if (!outcome.result.cells.empty()) {
    body +=
        html_figure("Error by condition", conditions_figure(outcome.result), "Mean error of the last frame.");
    body += html_figure("Error over the frames", frames_figure(outcome.result), "Mean error of the network.");
  }
  body += html_figure("Training", training_curve(settings.folder), "Validation error.");
  body +=
      html_figure("Moving panels", joints_figure(outcome),
                  "Nominal, last frame; the surface in the image has the panels as they stand in the mesh.");
  body += "</div>\n";
  body += "<h2>Steps</h2>\n" + html_text(times_table(outcome.steps), "results");
  body += list_of("Remarks", outcome.remarks);
  return html_page("adoption of " + settings.mission.title,
                   body + html_footer(local_time_text(), settings.command));
}

void write_adoption_report(const AdoptionSettings& settings, const AdoptionOutcome& outcome,
                           const TriangleMesh& mesh) {
  const std::string& folder = settings.folder;
  write_file(folder + "/verdict.json", verdict_json(settings, outcome).dump(2) + "\n");
  write_file(folder + "/report.html", adoption_page(settings, outcome));
  MeshReport report;
  report.file = settings.mission.mesh.file;
  report.options = mesh_file_options(settings.mission.mesh);
  report.found = outcome.mesh;
  report.command = settings.command;
  report.generated = local_time_text();
  write_file(folder + "/mesh.html", mesh_page(report, six_views(mesh, kPagePixels)));
  if (!outcome.result.cells.empty())
    write_file(folder + "/evaluation.html", results_page(results_of(settings, outcome)));
}

}  // namespace tumblesight::sim

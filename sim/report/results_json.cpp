#include "sim/report/results_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/evaluation/pose_goals.hpp"
#include "sim/report/error_json.hpp"
#include "sim/report/results_columns.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::ordered_json;

Json confusion_json(const Confusion& confusion) {
  Json json = Json::object();
  for (std::size_t i = 0; i < confusion.names.size(); ++i) json[confusion.names[i]] = confusion.shares[i];
  json["none"] = confusion.none;
  json["blur_deg"] = confusion.blur_deg;
  return json;
}

Json figure_json(const std::optional<PaperFigure>& figure) {
  if (!figure) return nullptr;
  return {{"mean_deg", figure->mean_deg}, {"within_20deg", figure->within_20deg}};
}

Json goal_json(const std::optional<PoseGoal>& goal) {
  if (!goal) return nullptr;
  return {{"pose_mean_within_20_deg", goal->most_mean_within_20_deg},
          {"pose_within_20deg", goal->least_within_20deg}};
}

Json baseline_json(const CellResult& cell) {
  if (!cell.baseline) return nullptr;
  Json json = summary_json(*cell.baseline);
  json["sequences"] = cell.baseline->count;
  return json;
}

Json curve_json(const Curve& curve) {
  Json json = Json::array();
  for (const CurvePoint& point : curve) {
    json.push_back({{"at", point.at},
                    {"sequences", point.rcnn.count},
                    {"rcnn", summary_json(point.rcnn)},
                    {"cnn", summary_json(point.cnn)}});
  }
  return json;
}

Json rare_events_json(const RareEvents& events) {
  Json json = Json::object();
  const std::vector<RareEventRow>& table = rare_event_table();
  for (std::size_t i = 0; i < events.counts.size(); ++i) {
    if (table[i].of_pose && !events.has_poses) {
      json[table[i].key] = nullptr;
      continue;
    }
    const ShareBounds bounds = share_bounds_95(events.counts[i], events.of);
    json[table[i].key] = {
        {"count", events.counts[i]}, {"of", events.of}, {"low_95", bounds.low}, {"high_95", bounds.high}};
  }
  return json;
}

Json worst_json(const RareEvents& events) {
  Json json = Json::array();
  for (const WorstSequence& one : events.worst)
    json.push_back({{"sequence", one.sequence},
                    {"error_deg", one.error_deg},
                    {"valid", one.valid},
                    {"pose_deg", events.has_poses ? Json(one.pose_deg) : Json()},
                    {"pose_verified", events.has_poses ? Json(one.pose_verified) : Json()},
                    {"range_m", one.range_m},
                    {"rate_deg_s", one.rate_deg_s}});
  return json;
}

Json row_json(const Results& results, const SubjectResult& subject, const CellResult& cell) {
  const PaperFigures paper = paper_figures(subject.target, cell);
  Json json{{"target", subject.target},
            {"mesh", subject.mesh},
            {"condition", to_string(cell.condition)},
            {"sequences", cell.sequences},
            {"rcnn", estimator_json(cell.rcnn)},
            {"cnn", estimator_json(cell.cnn)},
            {"pose", pose_json(cell.pose)},
            {"pose_first", pose_json(cell.pose_first)},
            {"baseline", baseline_json(cell)},
            {"frames", cell.frames},
            {"disturbances", disturbances_json(cell.disturbances)},
            {"effect", effect_json(cell.effects)},
            {"seed", results.seed},
            {"model", subject.model},
            {"model_crc32", fmt::format("{:08x}", subject.model_crc32)},
            {"paper_rcnn", figure_json(paper.rcnn)},
            {"paper_cnn", figure_json(paper.cnn)},
            {"goal", goal_json(pose_goal(subject.target, cell))},
            {"confusion", confusion_json(cell.rcnn_confusion)},
            {"rare_events", rare_events_json(cell.rare)},
            {"worst", worst_json(cell.rare)}};
  if (!subject.variant.empty()) json["variant"] = subject.variant;
  if (!cell.symmetry.is_none()) json["symmetry"] = to_string(cell.symmetry);
  if (is_mostly_wrong(cell)) json["mostly_wrong"] = true;
  if (!cell.sensor.is_the_papers()) json["sensor"] = sensor_json(cell.sensor);
  if (!cell.ranges.are_the_papers()) json["ranges_m"] = {cell.ranges.nearest_m, cell.ranges.farthest_m};
  // What an effect or a sensor costs depends on the range.
  if (differs_from_paper(cell)) json["by_range_m"] = curve_json(cell.by_range);
  return json;
}

Json reliability_json(const std::vector<ReliabilityBin>& bins) {
  Json json = Json::array();
  for (const ReliabilityBin& bin : bins) {
    json.push_back(
        {{"predicted_deg", bin.predicted_deg}, {"real_deg", bin.real.mean_deg}, {"frames", bin.real.count}});
  }
  return json;
}

Json detection_json(const std::vector<DetectionPoint>& points) {
  Json json = Json::array();
  for (const DetectionPoint& point : points) {
    json.push_back({{"threshold_deg", point.threshold_deg},
                    {"wrong", point.wrong},
                    {"wrong_flagged", point.wrong_flagged},
                    {"right", point.right},
                    {"right_flagged", point.right_flagged}});
  }
  return json;
}

Json curves_json(const SubjectResult& subject) {
  const CellResult& base = subject.cells.front();
  return {{"target", subject.target},
          {"mesh", subject.mesh},
          {"model", subject.model},
          {"condition", to_string(base.condition)},
          {"by_frame", curve_json(base.by_frame)},
          {"by_range_m", curve_json(base.by_range)},
          {"by_rate_components_deg_s", curve_json(base.by_rate)},
          {"by_rate_norm_deg_s", curve_json(subject.sweeps->by_rate_norm)},
          {"by_hidden_share", curve_json(subject.sweeps->by_hidden_share)},
          {"long_run_by_frame", curve_json(subject.sweeps->long_run)},
          {"histogram_limits_deg", histogram_limits_deg()},
          {"histogram_rcnn", base.rcnn_histogram},
          {"histogram_cnn", base.cnn_histogram},
          {"reliability", reliability_json(base.reliability)},
          {"detection_all_conditions", detection_json(detection_of(subject))}};
}

}  // namespace

Json results_json(const Results& results) {
  Json rows = Json::array();
  Json curves = Json::array();
  for (const SubjectResult& subject : results.subjects) {
    for (const CellResult& cell : subject.cells) rows.push_back(row_json(results, subject, cell));
    for (const auto* further : {&subject.disturbed, &subject.sensor_runs})
      for (const CellResult& cell : *further) rows.push_back(row_json(results, subject, cell));
    if (subject.sweeps && !subject.cells.empty()) curves.push_back(curves_json(subject));
  }
  Json json{{"rows", rows}};
  if (!curves.empty()) json["curves"] = curves;
  return json;
}

}  // namespace tumblesight::sim

#include "sim/report/replay_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <nlohmann/json.hpp>

#include "gnc/lidar/target_selection.hpp"
#include "sim/evaluation/chance.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/host/text.hpp"
#include "sim/report/error_json.hpp"
#include "sim/report/sil_report.hpp"
#include "sim/world/math/angles.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegPerMicroradian = 1e-6 * kDegPerRad;

double expected_deg(const ReplayRow& row) {
  return kDegPerMicroradian * row.attitude.predicted_error_urad;
}

// The counter that has grown since the telemetry of the cycle before.
std::optional<Refusal> refusal_of(const hal::Telemetry& now, const hal::Telemetry& before) {
  const std::pair<Refusal, bool> grown[] = {
      {Refusal::kDuplicate, now.frames_duplicate > before.frames_duplicate},
      {Refusal::kStale, now.frames_stale > before.frames_stale},
      {Refusal::kBad, now.frames_bad > before.frames_bad},
      {Refusal::kRepeated, now.frames_repeated > before.frames_repeated},
      {Refusal::kWithoutChaser, now.frames_without_chaser > before.frames_without_chaser}};
  for (const auto& [refusal, has_grown] : grown) {
    if (has_grown) return refusal;
  }
  return std::nullopt;
}

// Returns that count as none are why a frame with many has too few.
std::string too_few_returns(const ReplayedFrame* frame) {
  std::string text = "too few returns";
  if (frame == nullptr) return text;
  if (frame->nearer > 0)
    text += fmt::format(", {} nearer than {} m left out", frame->nearer, gnc::kMinRange_m);
  if (frame->farther > 0) text += fmt::format(", {} beyond {} m left out", frame->farther, gnc::kMaxRange_m);
  return text;
}

std::string bad_content(std::int32_t status, const ReplayedFrame* frame) {
  switch (static_cast<gnc::FrameStatus>(status)) {
    case gnc::FrameStatus::kOk:
      break;
    case gnc::FrameStatus::kBadRayCount:
      return "bad number of rays";
    case gnc::FrameStatus::kBadFov:
      return "bad field of view";
    case gnc::FrameStatus::kEmpty:
      return too_few_returns(frame);
    case gnc::FrameStatus::kFlat:
      return "all returns at one range";
  }
  return "bad";
}

// The event says more than the counter, but events that come too often are suppressed.
std::string reason(const StepResult& step, Refusal refusal, const ReplayedFrame* frame) {
  for (const hal::Event& event : step.events) {
    switch (event.id) {
      case hal::EventId::kFrameExposureBackwards:
        return "exposure backwards";
      case hal::EventId::kFrameStale:
        return "too old";
      case hal::EventId::kFrameFromFuture:
        return "from the future";
      case hal::EventId::kFrameTooSoon:
        return "too soon";
      case hal::EventId::kFrameWithoutChaser:
        return "chaser unknown";
      case hal::EventId::kFrameBad:
        return bad_content(event.arguments[1], frame);
      default:
        break;
    }
  }
  return to_string(refusal);
}

std::string doubts_text(std::uint8_t doubts) {
  std::string text;
  if ((doubts & hal::kDoubtErrorLarge) != 0) text += ", expected error";
  if ((doubts & hal::kDoubtAttitudeJump) != 0) text += ", jump";
  if ((doubts & hal::kDoubtUnexplained) != 0) text += ", not explained by the target";
  return text.empty() ? text : ": " + text.substr(2);
}

std::string status_text(const StepResult& step, const std::optional<Refusal>& refusal,
                        const ReplayedFrame* frame) {
  switch (step.attitude.validity) {
    case hal::Validity::kValid:
      return "valid";
    case hal::Validity::kDoubtful:
      return "doubtful" + doubts_text(step.attitude.doubts);
    case hal::Validity::kNoFrame:
      return "no frame";
    case hal::Validity::kFrameRefused:
      return "refused" + (refusal ? ": " + reason(step, *refusal, frame) : "");
    case hal::Validity::kPassedOver:
      return "passed over";
    case hal::Validity::kStandby:
      return "standby";
  }
  return "unknown";
}

double angle_deg(const FrameTruth& truth, const std::array<std::int32_t, 4>& q) {
  return kDegPerRad * angular_error_rad(truth.q_lrf_trf, gnc::to_double(q));
}

ReplayRow row_of(const StepResult& step, const hal::Telemetry& before, const ReplayedFrame* frame) {
  ReplayRow row;
  row.time_ns = step.time_ns;
  row.attitude = step.attitude;
  row.has_attitude = gives_attitude(step.attitude);
  row.truth_known = step.truth_known;
  if (step.attitude.validity == hal::Validity::kFrameRefused)
    row.refusal = refusal_of(step.telemetry, before);
  row.status = status_text(step, row.refusal, frame);
  if (frame != nullptr) row.frame = *frame;
  if (row.has_attitude && step.truth_known) {
    row.error_deg = angle_deg(step.truth, step.attitude.q_lrf_trf);
    row.single_frame_error_deg = angle_deg(step.truth, step.attitude.q_lrf_trf_single_frame);
  }
  return row;
}

std::vector<ReplayRow> rows_of(const SilRunResult& run, const std::vector<ReplayedFrame>& frames) {
  std::vector<ReplayRow> rows;
  hal::Telemetry before;
  auto frame = frames.begin();
  for (std::uint32_t k = 0; k < run.steps.size(); ++k) {
    const StepResult& step = run.steps[k];
    const bool sent = frame != frames.end() && frame->cycle_time_ns == step.time_ns;
    if (step.answered) {
      rows.push_back(row_of(step, before, sent ? &*frame : nullptr));
      rows.back().cycle = k;
      before = step.telemetry;
    }
    if (sent) ++frame;
  }
  return rows;
}

double range_m(const hal::AttitudeReport& report) {
  const auto& mm = report.centroid_lrf_mm;
  return 1e-3 * Eigen::Vector3d(mm[0], mm[1], mm[2]).norm();
}

// The steps as those of a run with simulated sequences, to have its figures: a sequence is a track, only
// attitudes whose truth is known are answers, and only frames with an attitude are pictured.
SilRunResult by_track(const SilRunResult& run) {
  SilRunResult tracks = run;
  const auto has_no_attitude = [&](const auto& picture) {
    const StepResult& step = run.steps[picture.first];
    return !step.answered || !gives_attitude(step.attitude);
  };
  tracks.pictures.erase(std::remove_if(tracks.pictures.begin(), tracks.pictures.end(), has_no_attitude),
                        tracks.pictures.end());
  std::uint32_t track = 0;
  std::uint32_t last_frame = 0;
  for (StepResult& step : tracks.steps) {
    step.answered = step.answered && gives_attitude(step.attitude);
    if (!step.answered) continue;
    const std::uint32_t frame = step.attitude.frames_since_reset - 1;
    if (last_frame > 0 && frame < last_frame) ++track;
    last_frame = frame + 1;
    step.sequence = track;
    step.frame_index = frame;
    step.truth.range_m = range_m(step.attitude);
    step.answered = step.truth_known;
  }
  return tracks;
}

std::vector<double> values_of(const ReplayReport& report, const std::function<bool(const ReplayRow&)>& wanted,
                              const std::function<double(const ReplayRow&)>& value) {
  std::vector<double> values;
  for (const ReplayRow& row : report.rows) {
    if (wanted(row)) values.push_back(value(row));
  }
  return values;
}

bool is_scored(const ReplayRow& row) {
  return row.error_deg.has_value();
}
bool is_valid(const ReplayRow& row) {
  return row.attitude.validity == hal::Validity::kValid;
}

std::vector<double> errors_of_valid(const ReplayReport& report) {
  return values_of(
      report, [](const ReplayRow& row) { return is_scored(row) && is_valid(row); },
      [](const ReplayRow& row) { return *row.error_deg; });
}
std::vector<double> errors_of_all(const ReplayReport& report) {
  return values_of(report, is_scored, [](const ReplayRow& row) { return *row.error_deg; });
}
std::vector<double> errors_of_single_frames(const ReplayReport& report) {
  return values_of(report, is_scored, [](const ReplayRow& row) { return *row.single_frame_error_deg; });
}
std::vector<double> expected_errors(const ReplayReport& report) {
  return values_of(
      report, [](const ReplayRow& row) { return row.has_attitude; }, expected_deg);
}

template <class Wanted>
std::size_t count_rows(const ReplayReport& report, const Wanted& wanted) {
  return static_cast<std::size_t>(std::count_if(report.rows.begin(), report.rows.end(), wanted));
}

std::size_t count_validity(const ReplayReport& report, hal::Validity validity) {
  return count_rows(report, [&](const ReplayRow& row) { return row.attitude.validity == validity; });
}

std::size_t count_refused(const ReplayReport& report, Refusal refusal) {
  return count_rows(report, [&](const ReplayRow& row) { return row.refusal == refusal; });
}

std::vector<TableCell> errors_row(const std::string& name, Mark mark, const std::vector<double>& errors_deg) {
  const ErrorSummary summary = summarise(errors_deg);
  if (summary.count == 0) return {{name, mark}, {"-"}, {"-"}, {"-"}, {"-"}, {"-"}, {"0"}};
  return {{name, mark},
          {degrees_text(summary.mean_deg)},
          {degrees_text(summary.median_deg)},
          {degrees_text(*std::max_element(errors_deg.begin(), errors_deg.end()))},
          {percent_text(summary.within_5deg)},
          {percent_text(summary.within_20deg)},
          {std::to_string(summary.count)}};
}

std::string attitude_text(const std::array<std::int32_t, 4>& q30) {
  const Eigen::Quaterniond q = gnc::to_double(q30);
  return fmt::format("{:6.3f} {:6.3f} {:6.3f} {:6.3f}", q.w(), q.x(), q.y(), q.z());
}

std::vector<TableCell> table_row(const ReplayRow& row, std::int64_t start_ns) {
  std::vector<TableCell> cells{{std::to_string(row.cycle)},
                               {fmt::format("{:.3f} s", 1e-9 * static_cast<double>(row.time_ns - start_ns))}};
  if (row.frame) {
    cells.push_back({std::to_string(row.frame->stamp.sequence_number)});
    cells.push_back({std::to_string(row.frame->returns)});
  } else {
    cells.insert(cells.end(), 2, {"-"});
  }
  cells.push_back({row.status, row.refusal ? Mark::kMissed : Mark::kNone});
  if (row.has_attitude) {
    cells.push_back({fmt::format("{:.1f} m", range_m(row.attitude))});
    cells.push_back({attitude_text(row.attitude.q_lrf_trf)});
    cells.push_back({degrees_text(expected_deg(row)), Mark::kRcnn});
  } else {
    cells.insert(cells.end(), 3, {"-"});
  }
  cells.push_back({row.error_deg ? degrees_text(*row.error_deg) : "-", Mark::kRcnn});
  return cells;
}

std::vector<TableCell> gap_row(const ReplayRow& first, const ReplayRow& last, std::int64_t start_ns) {
  std::vector<TableCell> cells = table_row(first, start_ns);
  if (first.cycle == last.cycle) return cells;
  cells[0].text += fmt::format("…{}", last.cycle);
  cells[4].text += fmt::format(", {}", counted(last.cycle - first.cycle + 1, "cycle"));
  return cells;
}

bool is_gap(const ReplayRow& row) {
  return row.attitude.validity == hal::Validity::kNoFrame;
}

Json row_json(const ReplayRow& row) {
  Json json{{"cycle", row.cycle}, {"time_ns", row.time_ns}};
  json["sequence_number"] = row.frame ? Json(row.frame->stamp.sequence_number) : nullptr;
  json["exposure_time_ns"] = row.frame ? Json(row.frame->stamp.exposure_time_ns) : nullptr;
  json["returns"] = row.frame ? Json(row.frame->returns) : nullptr;
  json["status"] = row.status;
  json["doubts"] = row.attitude.doubts;
  json["frames_since_reset"] = row.attitude.frames_since_reset;
  const Eigen::Quaterniond q = gnc::to_double(row.attitude.q_lrf_trf);
  json["q_lrf_trf"] = row.has_attitude ? Json{q.w(), q.x(), q.y(), q.z()} : Json(nullptr);
  json["expected_error_deg"] = row.has_attitude ? Json(expected_deg(row)) : nullptr;
  json["error_deg"] = row.error_deg ? Json(*row.error_deg) : nullptr;
  return json;
}

Json counts_json(const ReplayReport& report) {
  Json json{{"cycles", report.run.steps_planned},
            {"frames", report.setup.frames},
            {"cycles_without_frame", count_validity(report, hal::Validity::kNoFrame)},
            {"valid", count_validity(report, hal::Validity::kValid)},
            {"doubtful", count_validity(report, hal::Validity::kDoubtful)}};
  for (std::size_t i = 0; i < kRefusals; ++i) {
    const auto refusal = static_cast<Refusal>(i);
    std::string key = to_string(refusal);
    std::replace(key.begin(), key.end(), ' ', '_');
    json["refused"][key] = count_refused(report, refusal);
  }
  return json;
}

}  // namespace

const char* to_string(Refusal refusal) {
  static constexpr std::array<const char*, kRefusals> kNames{"duplicate", "stale", "bad", "repeated",
                                                             "without chaser"};
  return kNames[static_cast<std::size_t>(refusal)];
}

ReplayedFrame replayed_frame(const StepResult& step, const gnc::RangeImage& frame) {
  const auto end = frame.ranges.begin() + std::ptrdiff_t{frame.rays} * frame.rays;
  ReplayedFrame replayed{step.time_ns, {frame.sequence_number, frame.exposure_time_ns}};
  for (auto range = frame.ranges.begin(); range != end; ++range) {
    if (*range == 0) continue;
    ++replayed.returns;
    if (*range < gnc::kMinRange_counts) ++replayed.nearer;
    if (*range > gnc::kMaxRange_counts) ++replayed.farther;
  }
  return replayed;
}

ReplayReport replay_report(const ReplaySetup& setup, const SilRunResult& run,
                           const std::vector<ReplayedFrame>& frames) {
  ReplayReport report;
  report.setup = setup;
  report.rows = rows_of(run, frames);
  const SilRunResult tracks = by_track(run);
  static_cast<FlightSetup&>(report.run.setup) = setup;
  report.run.frame_period_s = kFramePeriod_s;
  report.run.results = frame_results(tracks, std::nullopt);
  for (const FrameResult& result : report.run.results)
    report.run.setup.frames = std::max(report.run.setup.frames, result.frame + 1);
  report.run.pictures = depth_pictures(tracks, setup.projection);
  report.run.steps_planned = run.steps_planned;
  report.run.steps_missed = run.steps_missed;
  report.run.heap_allocations = run.flight_heap_allocations;
  report.run.inference_median_us = inference_time(run).median_us;
  report.run.inference_max_us = inference_time(run).max_us;
  report.run.trace_crc32 = run.trace_crc32;
  report.run.notices = flight_faults(run);
  report.run.facts = {replay_facts(report), outcome_facts(run, setup), counter_facts(run)};
  const FactList events = event_facts(run);
  if (!events.facts.empty()) report.run.facts.push_back(events);
  return report;
}

DataTable replay_table(const ReplayReport& report) {
  DataTable table{
      {"cycle", "time", "frame", "returns", "status", "range", "attitude w, x, y, z", "expected", "error"},
      {}};
  const std::int64_t start_ns = report.rows.empty() ? 0 : report.rows.front().time_ns;
  for (std::size_t i = 0; i < report.rows.size(); ++i) {
    const std::size_t first = i;
    while (is_gap(report.rows[first]) && i + 1 < report.rows.size() && is_gap(report.rows[i + 1])) ++i;
    table.rows.push_back(gap_row(report.rows[first], report.rows[i], start_ns));
  }
  if (!report.setup.truth.empty()) return table;
  table.header.pop_back();
  for (std::vector<TableCell>& row : table.rows) row.pop_back();
  return table;
}

FactList replay_facts(const ReplayReport& report) {
  FactList list{"Recording", {}};
  const auto add = [&](const char* name, std::size_t count) {
    list.facts.emplace_back(name, std::to_string(count));
  };
  list.facts.emplace_back("target", report.setup.target);
  add("frames", report.setup.frames);
  add("cycles", report.run.steps_planned);
  add("… without a frame", count_validity(report, hal::Validity::kNoFrame));
  add("attitudes, valid", count_validity(report, hal::Validity::kValid));
  add("… doubtful", count_validity(report, hal::Validity::kDoubtful));
  add("frames refused", count_validity(report, hal::Validity::kFrameRefused));
  for (std::size_t i = 0; i < kRefusals; ++i) {
    const auto refusal = static_cast<Refusal>(i);
    if (const std::size_t count = count_refused(report, refusal); count > 0)
      list.facts.emplace_back(fmt::format("… {}", to_string(refusal)), std::to_string(count));
  }
  const std::vector<double> expected = expected_errors(report);
  list.facts.emplace_back("expected error",
                          expected.empty() ? "none" : "median " + degrees_text(median(expected)));
  if (!report.setup.truth.empty())
    add("not in the truth",
        count_rows(report, [](const ReplayRow& row) { return row.frame && !row.truth_known; }));
  return list;
}

DataTable replay_errors_table(const ReplayReport& report) {
  DataTable table{
      {"error of the attitudes", "mean", "median", "largest", "within 5°", "within 20°", "frames"}, {}};
  if (report.setup.truth.empty()) return table;
  table.rows = {errors_row("RCNN, valid", Mark::kRcnn, errors_of_valid(report)),
                errors_row("RCNN, valid or doubtful", Mark::kRcnn, errors_of_all(report)),
                errors_row("CNN, each frame alone", Mark::kCnn, errors_of_single_frames(report))};
  return table;
}

std::string mostly_wrong_text(const ReplayReport& report) {
  return report.setup.shows_target ? mostly_wrong_text(summarise(errors_of_all(report))) : std::string{};
}

std::string nothing_accepted_text(const ReplayReport& report) {
  std::uint64_t frames = 0, returns = 0, nearer = 0, farther = 0;
  for (const ReplayRow& row : report.rows) {
    if (!row.frame) continue;
    if (row.refusal != Refusal::kBad) return {};
    ++frames;
    returns += row.frame->returns;
    nearer += row.frame->nearer;
    farther += row.frame->farther;
  }
  if (frames == 0 || !report.setup.shows_target) return {};
  std::string text =
      "No frame of the recording was accepted. Likely mistakes: points with other axes than the LiDAR "
      "frame's (+x to "
      "the right, +y along the boresight, +z up; in ROS, x is forward), a field of view in degrees where "
      "radians are "
      "expected, and coordinates in another unit than metres.";
  if (2 * nearer > returns)
    text += fmt::format(
        " Most returns are nearer than {} m, where the flight program takes them for parts of the chaser.",
        gnc::kMinRange_m);
  else if (2 * farther > returns)
    text += fmt::format(" Most returns are beyond {} m.", gnc::kMaxRange_m);
  else
    text += fmt::format(" The frames have {} returns on average.", returns / frames);
  return text;
}

Json replay_json(const ReplayReport& report, const SilRunResult& run) {
  Json json{{"recording", report.setup.recording},
            {"truth", report.setup.truth.empty() ? Json(nullptr) : Json(report.setup.truth)},
            {"target", report.setup.target},
            {"model_crc32", report.setup.model_crc32}};
  json.update(counts_json(report));
  const std::vector<double> expected = expected_errors(report);
  json["expected_error_median_deg"] = expected.empty() ? Json(nullptr) : Json(median(expected));
  if (!report.setup.truth.empty()) {
    json["error_valid"] = summary_json(summarise(errors_of_valid(report)));
    json["error_all"] = summary_json(summarise(errors_of_all(report)));
    json["error_single_frames"] = summary_json(summarise(errors_of_single_frames(report)));
    json["frames_scored"] = errors_of_all(report).size();
  }
  json.update(outcome_json(run));
  json["rows"] = Json::array();
  for (const ReplayRow& row : report.rows) json["rows"].push_back(row_json(row));
  return json;
}

}  // namespace tumblesight::sim

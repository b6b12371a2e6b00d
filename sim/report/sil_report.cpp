#include "sim/report/sil_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "hal/dds/idl/topics.hpp"
#include "hal/messages/event_text.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/host/text.hpp"
#include "sim/operations/fault_names.hpp"
#include "sim/report/error_json.hpp"

namespace tumblesight::sim {
namespace {

bool gave_attitude(const StepResult& step) {
  return step.answered && gives_attitude(step.attitude);
}

std::string file_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

const StepResult* last_answered(const SilRunResult& run) {
  const auto found =
      std::find_if(run.steps.rbegin(), run.steps.rend(), [](const StepResult& s) { return s.answered; });
  return found == run.steps.rend() ? nullptr : &*found;
}

std::uint32_t steps_answered(const SilRunResult& run) {
  return run.steps_planned - run.steps_missed - run.frames_superseded;
}

double swath_m_of(const FlightSetup& setup) {
  return 1e-3 * setup.projection.swath_mm;
}

std::string indices_text(const SilRunSetup& setup) {
  if (setup.only.empty()) return fmt::format("0 to {}", setup.sequences - 1);
  return fmt::format("{}", fmt::join(setup.only, ", "));
}

FactList settings_facts(const SilRunSetup& setup) {
  const std::string disturbed = to_string(setup.disturbances);
  const std::string effects = to_string(setup.effects);
  FactList list{"Settings", {}};
  list.facts = {{"target", setup.target},
                {"mesh", file_name(setup.mesh_name)},
                {"condition", setup.condition},
                {"sequences × frames", fmt::format("{} × {}", setup.sequences, setup.frames)},
                {"disturbances", disturbed.empty() ? "none" : disturbed},
                {"effects", effects.empty() ? "none" : effects},
                {"sensor", setup.sensor.name},
                {"ranges", to_string(setup.ranges)},
                {"seed", fmt::format("{}", setup.seed)},
                {"indices of the sequences", indices_text(setup)},
                {"speed", setup.speed > 0.0 ? fmt::format("{:g} × real time", setup.speed) : "max"},
                {"time", setup.free_running ? "free-running" : "lockstep"},
                {"swath", fmt::format("{:.2f} m", swath_m_of(setup))}};
  if (!setup.symmetry.is_none()) list.facts.emplace_back("errors modulo", to_string(setup.symmetry));
  return list;
}

FactList numerics_facts(const NumericsComparison& numerics) {
  return {"Float32 reference, same frames",
          {{"mean error, last frame",
            numerics.float32.count == 0 ? "–" : degrees_text(numerics.float32.mean_deg)},
           {"difference of the attitudes, mean", degrees_text(numerics.difference.mean_deg)},
           {"difference of the attitudes, max", degrees_text(numerics.largest_difference_deg)}}};
}

nlohmann::ordered_json faults_json(const std::vector<StandingFault>& faults) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const StandingFault& one : faults) {
    json[name_of(one.fault)] = {
        {"steps", one.steps}, {"sequences", one.sequences}, {"first_step", one.first_step}};
  }
  return json;
}

StandingFault standing_fault(const SilRunResult& run, hal::Fault fault) {
  StandingFault found{fault};
  std::optional<std::uint32_t> last_sequence;
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    const StepResult& step = run.steps[i];
    const bool stands = (step.telemetry.faults_persisting >> static_cast<unsigned>(fault) & 1U) != 0;
    if (!step.answered || !stands) continue;
    if (found.steps++ == 0) found.first_step = static_cast<std::uint32_t>(i);
    if (last_sequence != step.sequence) ++found.sequences;
    last_sequence = step.sequence;
  }
  return found;
}

}  // namespace

std::vector<ReportPicture> depth_pictures(const SilRunResult& run, const gnc::DepthProjection& projection) {
  const auto scratch = std::make_unique<gnc::DepthImageScratch>();
  std::vector<ReportPicture> pictures;
  for (const auto& [index, frame] : run.pictures) {
    if (index >= run.steps.size()) continue;
    const StepResult& step = run.steps[index];
    ReportPicture picture{step.sequence, step.frame_index, step.truth.range_m, {}};
    if (gnc::make_depth_image(frame, projection, *scratch, picture.image) == gnc::FrameStatus::kOk) {
      pictures.push_back(picture);
    }
  }
  return pictures;
}

FactList outcome_facts(const SilRunResult& run, const FlightSetup& setup) {
  const InferenceTime time = inference_time(run);
  FactList list{"Flight program", {}};
  list.facts = {{"steps", steps_text(run)},
                {"inference time, median", time_text(time.median_us)},
                {"inference time, max", time_text(time.max_us)},
                {"heap allocations", fmt::format("{}", run.flight_heap_allocations)},
                {"faults that stood", text_of(standing_faults(run))},
                {"trace CRC-32", fmt::format("{:08x}", run.trace_crc32)},
                {"model", file_name(setup.model_path)},
                {"model CRC-32", setup.model_crc32}};
  if (!run.requests.empty()) list.facts.emplace_back("requests while it ran", text_of(run.requests));
  return list;
}

FactList counter_facts(const SilRunResult& run) {
  FactList list{"Counters at the end", {}};
  const StepResult* last = last_answered(run);
  if (last == nullptr) return list;
  const hal::Telemetry& h = last->telemetry;
  const std::pair<const char*, std::uint32_t> counters[] = {
      {"cycles", h.cycles},
      {"frames used", h.frames_used},
      {"frames missing", h.frames_missing},
      {"frames refused", h.frames_refused},
      {"… duplicate, stale or bad", h.frames_duplicate + h.frames_stale + h.frames_bad},
      {"attitudes doubtful", h.attitudes_doubtful},
      {"poses verified", h.poses_verified},
      {"sequence numbers skipped", h.sequence_gaps},
      {"estimator resets", h.estimator_resets},
      {"commands accepted", h.commands_accepted},
      {"commands refused", h.commands_refused},
      {"events", h.events},
      {"deadline overruns", h.deadline_overruns},
      {"registrations cut short", h.registrations_cut_short},
      {"complete model checks", h.model_passes},
      {"memory errors repaired",
       h.memory_corrections + h.states_restored + h.constants_reloaded + h.model_blocks_repaired},
      {"stack never used [bytes]", h.stack_left_min_bytes},
  };
  for (const auto& [name, count] : counters) list.facts.emplace_back(name, fmt::format("{}", count));
  return list;
}

FactList event_facts(const SilRunResult& run) {
  struct Kind {
    hal::EventId id;
    std::uint32_t count;
    std::size_t first_step;
  };
  std::vector<Kind> kinds;
  for (std::size_t i = 0; i < run.steps.size(); ++i) {
    for (const hal::Event& event : run.steps[i].events) {
      if (event.severity == hal::Severity::kInformation) continue;
      const auto known =
          std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.id == event.id; });
      if (known != kinds.end()) {
        ++known->count;
      } else {
        kinds.push_back({event.id, 1, i});
      }
    }
  }
  FactList list{"Warnings and errors", {}};
  for (const Kind& kind : kinds) {
    list.facts.emplace_back(
        fmt::format("{} (event {})", text_of(kind.id), static_cast<int>(kind.id)),
        fmt::format("{}, first in step {}", counted(kind.count, "time"), kind.first_step));
  }
  return list;
}

std::vector<StandingFault> standing_faults(const SilRunResult& run) {
  std::vector<StandingFault> faults;
  for (int i = 0; i < hal::kFaults; ++i) {
    const StandingFault fault = standing_fault(run, static_cast<hal::Fault>(i));
    if (fault.steps > 0) faults.push_back(fault);
  }
  return faults;
}

std::string text_of(const std::vector<StandingFault>& faults) {
  std::string text;
  for (const StandingFault& one : faults) {
    text += fmt::format("{}{} in {} of {}", text.empty() ? "" : ", ", name_of(one.fault),
                        counted(one.steps, "step"), counted(one.sequences, "sequence"));
  }
  return text.empty() ? "none" : text;
}

std::string text_of(const std::vector<RunRequest>& requests) {
  constexpr std::size_t kMostShown = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(requests.size(), kMostShown); ++i)
    text += fmt::format("{}step {}: {}", i == 0 ? "" : "; ", requests[i].step, requests[i].what);
  if (requests.size() > kMostShown) text += fmt::format("; and {} more", requests.size() - kMostShown);
  return text.empty() ? "none" : text;
}

std::string steps_text(const SilRunResult& run) {
  std::string text = fmt::format("{} of {} answered", steps_answered(run), run.steps_planned);
  if (run.frames_superseded > 0)
    text += fmt::format(", {} superseded by a newer frame of the same cycle", run.frames_superseded);
  return text;
}

std::string time_text(double time_us) {
  return time_us > 0.0 ? fmt::format("{:.2f} ms", 1e-3 * time_us) : "none";
}

StatedPose stated_pose(const hal::AttitudeReport& report) {
  StatedPose pose;
  pose.doubts = report.pose_doubts;
  pose.state.q_lrf_trf = report.pose_q_lrf_trf;
  pose.state.origin_lrf_um = report.pose_origin_lrf_um;
  pose.state.rate_lrf_urad_s = report.pose_rate_lrf_urad_s;
  pose.state.velocity_lrf_um_s = report.pose_velocity_lrf_um_s;
  pose.covariance.sigma = report.pose_sigma;
  pose.covariance.correlation_q15 = report.pose_correlation_q15;
  return pose;
}

std::vector<FrameResult> frame_results(const SilRunResult& run, std::optional<double> swath_m,
                                       const TargetSymmetry& symmetry) {
  std::vector<FrameResult> results;
  for (const StepResult& step : run.steps) {
    if (!step.answered) continue;
    FrameResult result;
    result.sequence = step.sequence;
    result.frame = step.frame_index;
    result.valid = gave_attitude(step);
    result.owed = step.truth.is_genuine();
    result.trusted = step.attitude.validity == hal::Validity::kValid;
    result.truth = step.truth.q_lrf_trf;
    result.rcnn = gnc::to_double(step.attitude.q_lrf_trf);
    result.cnn = gnc::to_double(step.attitude.q_lrf_trf_single_frame);
    result.rcnn_predicted_rad = 1e-6 * step.attitude.predicted_error_urad;
    result.cnn_predicted_rad = 1e-6 * step.attitude.predicted_error_single_frame_urad;
    if (result.valid && swath_m)
      result.pose = pose_errors(stated_pose(step.attitude), step.truth, *swath_m, symmetry);
    take_nearest_equivalents(result, symmetry);
    results.push_back(result);
  }
  return results;
}

InferenceTime inference_time(const SilRunResult& run) {
  std::vector<double> times_us;
  for (const StepResult& step : run.steps) {
    if (gave_attitude(step)) times_us.push_back(step.telemetry.inference_us);
  }
  if (times_us.empty()) return {};
  return {median(times_us), *std::max_element(times_us.begin(), times_us.end())};
}

std::vector<std::string> flight_faults(const SilRunResult& run) {
  std::vector<std::string> found;
  if (!run.failure.empty()) found.push_back("The run ended early: " + run.failure + ".");
  const bool ended_before_the_first = !run.failure.empty() && run.steps_missed == run.steps_planned;
  if (run.steps_missed > 0 && !ended_before_the_first) {
    found.push_back(fmt::format("{} of {} steps were not answered; the figures cover the others.",
                                run.steps_missed, run.steps_planned));
  }
  const StepResult* last = last_answered(run);
  if (last != nullptr && last->telemetry.commands_refused > 0) {
    found.push_back(
        fmt::format("The flight program refused {}; see its command counter, its key and the arguments.",
                    counted(last->telemetry.commands_refused, "telecommand")));
  }
  if (run.flight_heap_allocations > 0) {
    found.push_back(fmt::format("The flight task allocated heap memory {} times after its start.",
                                run.flight_heap_allocations));
  }
  return found;
}

std::vector<std::string> run_faults(const SilRunResult& run) {
  std::vector<std::string> found = flight_faults(run);
  const StepResult* last = last_answered(run);
  const auto invalid = std::count_if(run.steps.begin(), run.steps.end(), [](const StepResult& s) {
    return s.answered && s.truth.is_genuine() && !gave_attitude(s);
  });
  if (invalid > 0) {
    found.push_back(fmt::format(
        "{} of {} answers held no valid attitude{}; they count as 180° off.", invalid, steps_answered(run),
        last->telemetry.mode != hal::Mode::kRun ? ": the flight program is not in RUN" : ""));
  }
  return found;
}

nlohmann::ordered_json outcome_json(const SilRunResult& run) {
  const InferenceTime time = inference_time(run);
  const bool timed = time.max_us > 0.0;
  nlohmann::ordered_json json;
  json["inference_us"] = {{"median", timed ? nlohmann::ordered_json(time.median_us) : nullptr},
                          {"max", timed ? nlohmann::ordered_json(time.max_us) : nullptr}};
  json["flight_heap_allocations"] = run.flight_heap_allocations;
  json["steps_missed"] = run.steps_missed;
  json["frames_superseded"] = run.frames_superseded;
  json["trace_crc32"] = run.trace_crc32;
  json["faults"] = faults_json(standing_faults(run));
  json["requests"] = nlohmann::ordered_json::array();
  for (const RunRequest& request : run.requests)
    json["requests"].push_back({{"step", request.step}, {"request", request.what}});
  return json;
}

nlohmann::ordered_json run_json(const SilRunSetup& setup, const SilRunResult& run,
                                const std::optional<NumericsComparison>& numerics) {
  const std::vector<FrameResult> results = frame_results(run, swath_m_of(setup), setup.symmetry);
  nlohmann::ordered_json json{
      {"target", setup.target}, {"condition", setup.condition}, {"sequences", setup.sequences}};
  if (!setup.only.empty()) json["only"] = setup.only;
  json["disturbances"] = disturbances_json(setup.disturbances);
  json["effect"] = effect_json(setup.effects);
  if (!setup.sensor.is_the_papers()) json["sensor"] = sensor_json(setup.sensor);
  if (!setup.ranges.are_the_papers()) json["ranges_m"] = {setup.ranges.nearest_m, setup.ranges.farthest_m};
  if (!setup.symmetry.is_none()) json["symmetry"] = to_string(setup.symmetry);
  json["rcnn"] = estimator_json(last_frame_summary(results, setup.frames, Estimator::kRcnn));
  json["cnn"] = estimator_json(last_frame_summary(results, setup.frames, Estimator::kCnn));
  json["pose"] = pose_json(pose_summary(results, setup.frames - 1));
  json["pose_first"] = pose_json(pose_summary(results, 0));
  if (numerics) {
    json["float32"] = summary_json(numerics->float32);
    json["difference_to_float32"] = {{"mean_deg", numerics->difference.mean_deg},
                                     {"max_deg", numerics->largest_difference_deg}};
  }
  json.update(outcome_json(run));
  return json;
}

RunReport run_report(const SilRunSetup& setup, const SilRunResult& run,
                     const std::optional<NumericsComparison>& numerics) {
  const InferenceTime time = inference_time(run);
  RunReport report;
  report.setup = setup;
  report.frame_period_s = setup.disturbances.period_s;
  report.results = frame_results(run, swath_m_of(setup), setup.symmetry);
  report.pictures = depth_pictures(run, setup.projection);
  if (to_string(setup.effects).empty() && setup.sensor.is_the_papers() && setup.ranges.are_the_papers() &&
      setup.symmetry.is_none() && run.requests.empty())
    report.paper = paper_figures(setup.target, condition_from(setup.condition), setup.disturbances);
  report.steps_planned = run.steps_planned;
  report.steps_missed = run.steps_missed;
  report.frames_superseded = run.frames_superseded;
  report.heap_allocations = run.flight_heap_allocations;
  report.inference_median_us = time.median_us;
  report.inference_max_us = time.max_us;
  report.trace_crc32 = run.trace_crc32;
  report.notices = run_faults(run);
  report.facts = {settings_facts(setup), outcome_facts(run, setup), counter_facts(run)};
  if (numerics) report.facts.push_back(numerics_facts(*numerics));
  const FactList events = event_facts(run);
  if (!events.facts.empty()) report.facts.push_back(events);
  return report;
}

}  // namespace tumblesight::sim

#include "sim/cli/sil_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "hal/dds/idl/topics.hpp"
#include "sim/evaluation/statistics.hpp"
#include "sim/report/results_json.hpp"

namespace tumblesight::sim {
namespace {

bool gave_attitude(const StepRecord& step) {
  return step.answered && gives_attitude(step.attitude);
}

std::string file_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

const StepRecord* last_answered(const SilRecording& recording) {
  const auto found = std::find_if(recording.steps.rbegin(), recording.steps.rend(),
                                  [](const StepRecord& s) { return s.answered; });
  return found == recording.steps.rend() ? nullptr : &*found;
}

std::vector<ReportPicture> pictures(const SilRecording& recording, const gnc::DepthProjection& projection) {
  const auto scratch = std::make_unique<gnc::DepthImageScratch>();
  std::vector<ReportPicture> pictures;
  for (const auto& [index, frame] : recording.pictures) {
    if (index >= recording.steps.size()) continue;
    const StepRecord& step = recording.steps[index];
    ReportPicture picture{step.sequence, step.frame_index, step.truth.range_m, {}};
    if (gnc::make_depth_image(frame, projection, *scratch, picture.image) == gnc::FrameStatus::kOk) {
      pictures.push_back(picture);
    }
  }
  return pictures;
}

FactList settings_facts(const ScenarioArguments& scenario, const TargetSetup& setup,
                        const SilSettings& settings) {
  FactList list{"Settings", {}};
  list.facts = {{"target", scenario.target},
                {"mesh", file_name(setup.mesh_name)},
                {"condition", scenario.condition},
                {"sequences × frames", fmt::format("{} × {}", scenario.sequences, scenario.frames)},
                {"seed", fmt::format("{}", scenario.seed)},
                {"speed", settings.speed > 0.0 ? fmt::format("{:g} × real time", settings.speed) : "max"},
                {"time", settings.free_running ? "free-running" : "lockstep"},
                {"swath", fmt::format("{:.2f} m", 1e-3 * setup.projection.swath_mm)}};
  return list;
}

FactList outcome_facts(const SilRecording& recording, const TargetSetup& setup) {
  const InferenceTime time = inference_time(recording);
  FactList list{"Flight program", {}};
  list.facts = {
      {"steps answered",
       fmt::format("{} of {}", recording.steps_planned - recording.steps_missed, recording.steps_planned)},
      {"inference, median", fmt::format("{:.2f} ms", 1e-3 * time.median_us)},
      {"inference, longest", fmt::format("{:.2f} ms", 1e-3 * time.max_us)},
      {"heap allocations", fmt::format("{}", recording.flight_heap_allocations)},
      {"trace CRC-32", fmt::format("{:08x}", recording.trace_crc32)},
      {"model", file_name(setup.model_path)},
      {"model CRC-32", setup.model_status == gnc::ModelStatus::kOk ? fmt::format("{:08x}", setup.header.crc32)
                                                                   : gnc::to_string(setup.model_status)}};
  return list;
}

FactList counter_facts(const SilRecording& recording) {
  FactList list{"Counters at the end", {}};
  const StepRecord* last = last_answered(recording);
  if (last == nullptr) return list;
  const hal::Telemetry& h = last->telemetry;
  const std::pair<const char*, std::uint32_t> counters[] = {
      {"cycles", h.cycles},
      {"frames used", h.frames_used},
      {"frames missing", h.frames_missing},
      {"frames refused", h.frames_refused},
      {"… duplicate, stale, bad", h.frames_duplicate + h.frames_stale + h.frames_bad},
      {"attitudes flagged doubtful", h.attitudes_doubtful},
      {"sequence numbers skipped", h.sequence_gaps},
      {"estimator resets", h.estimator_resets},
      {"commands accepted", h.commands_accepted},
      {"commands refused", h.commands_refused},
      {"events", h.events},
      {"deadline overruns", h.deadline_overruns},
      {"model checked whole", h.model_passes},
      {"memory repaired",
       h.memory_corrections + h.states_restored + h.constants_reloaded + h.model_blocks_repaired},
      {"bytes of its stack never used", h.stack_left_min_bytes},
  };
  for (const auto& [name, count] : counters) list.facts.emplace_back(name, fmt::format("{}", count));
  return list;
}

// Warnings and errors by number, in the order in which they first came up.
FactList event_facts(const SilRecording& recording) {
  struct Kind {
    hal::EventId id;
    std::uint32_t count;
    std::size_t first_step;
  };
  std::vector<Kind> kinds;
  for (std::size_t i = 0; i < recording.steps.size(); ++i) {
    for (const hal::Event& event : recording.steps[i].events) {
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
    list.facts.emplace_back(fmt::format("event {}", static_cast<int>(kind.id)),
                            fmt::format("{} times, first in step {}", kind.count, kind.first_step));
  }
  return list;
}

}  // namespace

std::vector<FrameResult> frame_results(const SilRecording& recording) {
  std::vector<FrameResult> results;
  for (const StepRecord& step : recording.steps) {
    if (!step.answered) continue;
    FrameResult result;
    result.sequence = step.sequence;
    result.frame = step.frame_index;
    result.valid = gave_attitude(step);
    result.truth = step.truth.q_lrf_trf;
    result.rcnn = gnc::to_double(step.attitude.q_lrf_trf);
    result.cnn = gnc::to_double(step.attitude.q_lrf_trf_single_frame);
    result.rcnn_predicted_rad = 1e-6 * step.attitude.predicted_error_urad;
    result.cnn_predicted_rad = 1e-6 * step.attitude.predicted_error_single_frame_urad;
    results.push_back(result);
  }
  return results;
}

InferenceTime inference_time(const SilRecording& recording) {
  std::vector<double> times_us;
  for (const StepRecord& step : recording.steps) {
    if (gave_attitude(step)) times_us.push_back(step.telemetry.inference_us);
  }
  if (times_us.empty()) return {};
  return {median(times_us), *std::max_element(times_us.begin(), times_us.end())};
}

std::vector<std::string> shortcomings(const SilRecording& recording) {
  std::vector<std::string> found;
  if (!recording.failure.empty()) found.push_back("The run ended early: " + recording.failure + ".");
  if (recording.steps_missed > 0) {
    found.push_back(fmt::format("{} of {} steps were not answered; the figures cover the others.",
                                recording.steps_missed, recording.steps_planned));
  }
  const StepRecord* last = last_answered(recording);
  const auto invalid = std::count_if(recording.steps.begin(), recording.steps.end(),
                                     [](const StepRecord& s) { return s.answered && !gave_attitude(s); });
  if (invalid > 0) {
    found.push_back(
        fmt::format("{} of {} answers held no valid attitude{}; they count as 180° off.", invalid,
                    recording.steps_planned - recording.steps_missed,
                    last->telemetry.mode != hal::Mode::kRun ? ": the flight program is not in RUN" : ""));
  }
  if (recording.flight_heap_allocations > 0) {
    found.push_back(fmt::format("The flight task allocated heap memory {} times after its start.",
                                recording.flight_heap_allocations));
  }
  return found;
}

FactList numerics_facts(const NumericsComparison& numerics) {
  return {"The float32 reference, on the same frames",
          {{"mean error, last frame", degrees_text(numerics.float32.mean_deg)},
           {"attitudes differ by, mean", degrees_text(numerics.difference.mean_deg)},
           {"at most", degrees_text(numerics.largest_difference_deg)}}};
}

nlohmann::ordered_json run_json(const ScenarioArguments& scenario, const SilRecording& recording,
                                const std::optional<NumericsComparison>& numerics) {
  const std::vector<FrameResult> results = frame_results(recording);
  const InferenceTime time = inference_time(recording);
  nlohmann::ordered_json json{
      {"target", scenario.target}, {"condition", scenario.condition}, {"sequences", scenario.sequences}};
  json["rcnn"] = summary_json(summarise(last_frame_errors_deg(results, scenario.frames, Estimator::kRcnn)));
  json["cnn"] = summary_json(summarise(last_frame_errors_deg(results, scenario.frames, Estimator::kCnn)));
  if (numerics) {
    json["float32"] = summary_json(numerics->float32);
    json["difference_to_float32"] = {{"mean_deg", numerics->difference.mean_deg},
                                     {"max_deg", numerics->largest_difference_deg}};
  }
  json["inference_us"] = {{"median", time.median_us}, {"max", time.max_us}};
  json["flight_heap_allocations"] = recording.flight_heap_allocations;
  json["steps_missed"] = recording.steps_missed;
  json["trace_crc32"] = recording.trace_crc32;
  return json;
}

RunReport run_report(const ScenarioArguments& scenario, const TargetSetup& setup, const SilSettings& settings,
                     const SilRecording& recording) {
  const InferenceTime time = inference_time(recording);
  RunReport report;
  report.target = scenario.target;
  report.condition = scenario.condition;
  report.sequences = scenario.sequences;
  report.frames = scenario.frames;
  report.frame_period_s = kFramePeriod_s;
  report.results = frame_results(recording);
  report.pictures = pictures(recording, setup.projection);
  report.paper = paper_figures(scenario.target, condition_from(scenario.condition));
  report.steps_planned = recording.steps_planned;
  report.steps_missed = recording.steps_missed;
  report.heap_allocations = recording.flight_heap_allocations;
  report.inference_median_us = time.median_us;
  report.inference_max_us = time.max_us;
  report.trace_crc32 = recording.trace_crc32;
  report.notices = shortcomings(recording);
  report.remarks = setup.warnings;
  report.facts = {settings_facts(scenario, setup, settings), outcome_facts(recording, setup),
                  counter_facts(recording)};
  const FactList events = event_facts(recording);
  if (!events.facts.empty()) report.facts.push_back(events);
  return report;
}

}  // namespace tumblesight::sim

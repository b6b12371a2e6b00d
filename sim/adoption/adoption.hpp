// Adoption: from a mission file to a network that flies, and a verdict on it: mesh, training, fixed point,
// evaluation, flight over DDS.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sim/adoption/adoption_steps.hpp"
#include "sim/adoption/goal_check.hpp"
#include "sim/adoption/mesh_gate.hpp"
#include "sim/evaluation/results.hpp"
#include "sim/inspection/mesh_inspection.hpp"
#include "sim/mission/mission.hpp"
#include "sim/training/training_log.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/sensor/sensor_description.hpp"

namespace tumblesight::sim {

struct AdoptionSettings {
  Mission mission;
  SensorDescription sensor;
  std::function<RangeLimits(double swath_m)> ranges_of;  // of a target that needs this swath
  std::string folder;                                    // must exist
  double minutes = 60.0;
  std::uint64_t seed = 1;
  std::uint32_t sequences = 0;          // per row of the evaluation; 0: by the time
  std::vector<std::string> start_from;  // float32 images to choose from; empty: random weights
  bool start_was_given = false;         // by the user, not chosen from what ships
  int threads = 1;
  std::string program;  // of this tool, which flies the network
  std::string command;  // that was typed, for the report
};

struct AdoptionFlight {
  bool flown = false;
  bool well = false;   // every step was answered
  bool wrong = false;  // more than half of the attitudes
  std::string command;
};

struct AdoptionOutcome {
  bool stopped = false;  // by a signal: the same command goes on
  bool go = false;
  std::vector<std::string> reasons;  // why not
  std::vector<std::string> remarks;
  std::vector<std::string> outlook;  // what more time would bring
  std::vector<GoalCheck> checks;
  SubjectResult result;                  // its cells: the conditions of the goals
  std::vector<CellResult> joint_cells;   // nominal, at angles of the panels
  std::vector<double> joint_angles_deg;  // one per cell
  std::vector<TrainingPoint> training;
  std::vector<AdoptionStep> steps;
  std::string start_from;
  std::string model_path;  // in fixed point
  std::uint32_t model_crc32 = 0;
  MeshInspection mesh;
  AdoptionFlight flight;
  double minutes_taken = 0.0;
};

// Runs everything and writes into the folder: the model images, training/ with checkpoints and log,
// progress.html, verdict.json, report.html, evaluation.html, flight.html. Goes on where an earlier run of the
// same mission was stopped. Throws std::runtime_error or std::invalid_argument that names what is wrong.
AdoptionOutcome adopt(const AdoptionSettings& settings, const std::atomic<bool>& stop);

}  // namespace tumblesight::sim

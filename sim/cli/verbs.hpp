// The verbs of `tumblesight`. This build has those whose libraries it has.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sim/model/model_file.hpp"
#include "sim/quantization/quantize_file.hpp"
#include "sim/world/scenario/sequence.hpp"
#include "sim/world/target/triangle_mesh.hpp"

namespace tumblesight::sim {

// Adds the verbs that need no LibTorch to `app`, in the order in which --help lists them. `command_line`:
// what the user typed, for reports that name it.
void add_verbs(CLI::App& app, const std::string& command_line);
// Adds those that need it if it is there: `adopt`, `train`, and `bench`, which compares with it.
void add_libtorch_verbs(CLI::App& app, const std::string& command_line);

// `tumblesight simulate`: a software-in-the-loop run with the flight program, with figures and a report.
void add_simulate_command(CLI::App& app, const std::string& command_line);

// `tumblesight replay`: the flight program over a recording, with its attitudes compared with the truth.
void add_replay_command(CLI::App& app, const std::string& command_line);

// `tumblesight console`: a run on the bus or out of a recording, in the browser.
void add_console_command(CLI::App& app);

// `tumblesight mesh`: what a mesh file holds, what of it a network would suffer from, and a cleaned copy.
void add_mesh_command(CLI::App& app, const std::string& command_line);

// `tumblesight evaluate`: accuracy of a model over many sequences, from the renderer directly to the
// estimator.
void add_evaluate_command(CLI::App& app, const std::string& command_line);

// `tumblesight merge`: the figures of an evaluation out of its shards.
void add_merge_command(CLI::App& app);

// `tumblesight campaign`: many evaluations, on many cores or machines.
void add_campaign_command(CLI::App& app, const std::string& command_line);

// `tumblesight record`: renders frames into a recording, with their truth beside it.
void add_record_command(CLI::App& app);

// `tumblesight export`: a float32 model image as ONNX models, for other runtimes.
void add_export_command(CLI::App& app);

// `tumblesight train`: trains a network for a target and writes its model images.
void add_train_command(CLI::App& app);

// `tumblesight adopt`: from a mission file to a network that flies, and a verdict on it.
void add_adopt_command(CLI::App& app, const std::string& command_line);

// `tumblesight quantize`: makes the fixed-point model image that flies from a float32 one.
void add_quantize_command(CLI::App& app);

inline constexpr int kCalibrationSequences = 200;

// Shows its progress and prints the quantization error of each layer. Throws as quantize_to_file does.
// `seen`: sensor, ranges and period of the sequences, which take turns among `effect_sets`. Returns the
// report, by which the caller judges the image; with `refuse_another_network` it may not be written.
QuantizationReport quantize_and_report(const Float32Model& model, const std::vector<TriangleMesh>& meshes,
                                       int sequences, const std::string& out, const ScenarioSettings& seen,
                                       const std::vector<EffectRanges>& effect_sets,
                                       const TargetSymmetry& symmetry = {},
                                       bool refuse_another_network = false);

// `tumblesight bench`: speed of the flight network in both numerics and with every instruction set, compared
// with other runtimes.
void add_bench_command(CLI::App& app);

}  // namespace tumblesight::sim

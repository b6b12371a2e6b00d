
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "sim/cli/arguments.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/quantization/quantize_file.hpp"
#include "sim/quantization/surface_samples.hpp"
#include "sim/terminal/progress.hpp"

namespace tumblesight::sim {
namespace {

struct QuantizeArguments {
  std::string model;
  std::string out;
  MeshArguments meshes;
  Effects effects;
  int sequences = kCalibrationSequences;
  SensorArguments sensor;
  bool surface_only = false;
};

// near.float32.tsm -> near.tsm; anything else.tsm -> else.fixed.tsm
std::string default_out(const std::string& model) {
  std::filesystem::path path(model);
  path.replace_extension();
  if (path.extension() == ".float32") return path.replace_extension(".tsm").string();
  return path.string() + ".fixed.tsm";
}

void print_report(const QuantizationReport& report, const std::string& path) {
  fmt::print("\n  {:<8} {:>16} {:>12} {:>10}\n", "layer", "largest output", "saturated", "SNR");
  for (const LayerReport& layer : report.layers) {
    fmt::print("  {:<8} {:>16.3f} {:>10.3f} % {:>7.1f} dB\n", layer.layer, layer.largest,
               100.0 * layer.saturated, layer.snr_db);
  }
  fmt::print("\n  attitudes differ from float32 by {:.3f}° (mean), {:.3f}° (median), over {} frames\n",
             report.difference.mean_deg, report.difference.median_deg, report.difference.count);
  fmt::print("  {}, {} bytes, CRC-32 {:08x}\n\n", full_path(path), report.size_bytes, report.crc32);
}

// Writes the image `--model` with the surface of the first mesh.
void replace_surface(const QuantizeArguments& arguments) {
  if (arguments.out.empty()) throw CLI::ValidationError("--surface-only", "needs --out");
  require_different("--model", arguments.model, "--out", arguments.out);
  require_writable("--out", arguments.out);
  const gnc::ModelHeader header = read_fixed_point_header(arguments.model);
  const std::vector<TriangleMesh> meshes = load_meshes(arguments.meshes, header.target.data());
  const std::vector<std::uint8_t> surface =
      surface_section(meshes.front(), 1e-3 * header.projection.target_radius_mm);
  const std::uint32_t crc32 = write_with_surface(arguments.model, surface, arguments.out);
  const gnc::SurfaceModel points(surface.data());
  fmt::print("  {}, CRC-32 {:08x}: {} points of the surface, {} mm apart\n", full_path(arguments.out), crc32,
             points.points(), points.spacing_mm());
}

void quantize_file(QuantizeArguments arguments) {
  if (arguments.surface_only) {
    replace_surface(arguments);
    return;
  }
  require_the_target(arguments.effects);
  if (arguments.out.empty()) arguments.out = default_out(arguments.model);
  require_different("--model", arguments.model, "--out", arguments.out);
  require_writable("--out", arguments.out);
  const auto model = read_float32_model(arguments.model);
  std::vector<std::string> notes{check_sensor_of_model(arguments.model, arguments.sensor.sensor)};
  ScenarioSettings seen = seen_by(arguments.sensor, 1e-3 * model->header.projection.swath_mm, notes);
  seen.effects = arguments.effects;
  for (const std::string& note : notes) {
    if (!note.empty()) fmt::print(stderr, "  note: {}\n", note);
  }
  quantize_and_report(*model, load_meshes(arguments.meshes, model->header.target.data()), arguments.sequences,
                      arguments.out, seen);
  const bool known = std::filesystem::exists(sensor_file_of(arguments.model));
  if (known) write_sensor_file(arguments.out, arguments.sensor.sensor);
}

}  // namespace

void quantize_and_report(const Float32Model& model, const std::vector<TriangleMesh>& meshes, int sequences,
                         const std::string& out, const ScenarioSettings& seen) {
  ProgressBar bar("calibrating", "sequences", static_cast<std::uint64_t>(sequences));
  const QuantizationReport report = quantize_to_file(
      model, meshes, sequences, out, [&bar](std::uint64_t done) { bar.update(done); }, seen);
  bar.finish();
  print_report(report, out);
}

void add_quantize_command(CLI::App& app) {
  auto arguments = std::make_shared<QuantizeArguments>();
  CLI::App* command =
      app.add_subcommand("quantize", "Make the fixed-point model image that flies from a float32 one");
  command->footer(
      "\nWeights have 8 bits and a scale per channel, activations have 8 or 16 bits.\n"
      "The scales are chosen on rendered sequences. --effect: those that the network\n"
      "was trained with. The table shows the quantization error of each layer. The\n"
      "first mesh gives the surface by which the flight program checks what a frame\n"
      "shows.\n\n"
      "Example\n"
      "  tumblesight quantize --model out/near/near_shoemaker.float32.tsm \\\n"
      "      --mesh parametric --mesh near.stl\n");
  add_float32_model_option(*command, arguments->model);
  command->add_option("--out", arguments->out, "model image to write [--model without .float32]")
      ->check(file_path())
      ->type_name("FILE");
  add_mesh_options(*command, arguments->meshes);
  add_effect_option(*command, arguments->effects);
  add_sensor_options(*command, arguments->sensor);
  limit_whole_number(command->add_option("--sequences", arguments->sequences,
                                         "sequences of ten frames to render for calibration"),
                     10, 10'000)
      ->type_name("N")
      ->capture_default_str();
  command->add_flag("--surface-only", arguments->surface_only,
                    "--model is in fixed point: keep its weights, and replace its surface");
  command->callback([arguments] { quantize_file(*arguments); });
}

}  // namespace tumblesight::sim

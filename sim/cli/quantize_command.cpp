#include "sim/cli/quantize_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "sim/cli/arguments.hpp"
#include "sim/cli/surfaces.hpp"
#include "sim/quantization/quantize_file.hpp"
#include "sim/terminal/progress.hpp"

namespace tumblesight::sim {
namespace {

struct QuantizeArguments {
  std::string model;
  std::string out;
  SurfaceArguments surfaces;
  int sequences = kCalibrationSequences;
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
  fmt::print("\n  attitudes differ from float32's by {:.3f}° (mean), {:.3f}° (median), over {} frames\n",
             report.difference.mean_deg, report.difference.median_deg, report.difference.count);
  fmt::print("  {}, {} bytes, CRC-32 {:08x}\n\n", full_path(path), report.size_bytes, report.crc32);
}

void quantize_file(QuantizeArguments arguments) {
  if (arguments.out.empty()) arguments.out = default_out(arguments.model);
  require_different("--model", arguments.model, "--out", arguments.out);
  require_writable("--out", arguments.out);
  const auto model = read_float32_model(arguments.model);
  quantize_and_report(*model, load_surfaces(arguments.surfaces, model->header.target.data()),
                      arguments.sequences, arguments.out);
}

}  // namespace

void quantize_and_report(const Float32Model& model, const std::vector<TriangleMesh>& meshes, int sequences,
                         const std::string& out) {
  ProgressBar bar("calibrating", "sequences", static_cast<std::uint64_t>(sequences));
  const QuantizationReport report =
      quantize_to_file(model, meshes, sequences, out, [&bar](std::uint64_t done) { bar.update(done); });
  bar.finish();
  print_report(report, out);
}

void add_quantize_command(CLI::App& app) {
  auto arguments = std::make_shared<QuantizeArguments>();
  CLI::App* command =
      app.add_subcommand("quantize", "Turn a float32 model image into the fixed-point one that flies");
  command->footer(
      "\nWeights get 8 bits with a scale for each channel, activations 8 and 16, by what rendered\n"
      "sequences bring; the table says what each layer loses.\n\n"
      "Example\n"
      "  tumblesight quantize --model out/near/near_shoemaker.float32.tsm --mesh parametric --mesh "
      "near.stl\n");
  command->add_option("--model", arguments->model, "Model image in float32, as `tumblesight train` writes it")
      ->required()
      ->check(existing_model_image())
      ->type_name("FILE");
  command->add_option("--out", arguments->out, "Model image to write [--model without .float32]")
      ->type_name("FILE");
  add_surface_options(*command, arguments->surfaces);
  command->add_option("--sequences", arguments->sequences, "Rendered sequences of ten frames to calibrate on")
      ->check(whole_number(10, 10'000))
      ->capture_default_str();
  command->callback([arguments] { quantize_file(*arguments); });
}

}  // namespace tumblesight::sim

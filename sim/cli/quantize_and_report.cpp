#include "sim/cli/quantize_and_report.hpp"

#include <fmt/format.h>

#include "sim/cli/option_files.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/write_file.hpp"
#include "sim/surface/target_surface.hpp"

namespace tumblesight::sim {
namespace {

void print_report(const QuantizationReport& report, const std::string& path) {
  fmt::print("\n  {:<8} {:>16} {:>12} {:>10}\n", "layer", "largest output", "saturated", "SNR");
  for (const LayerReport& layer : report.layers) {
    fmt::print("  {:<8} {:>16.3f} {:>10.3f} % {:>7.1f} dB\n", layer.layer, layer.largest,
               100.0 * layer.saturated, layer.snr_db);
  }
  fmt::print("\n  attitudes differ from float32 by {:.3f}° (mean), {:.3f}° (median), over {} frames\n",
             report.difference.mean_deg, report.difference.median_deg, report.difference.count);
  if (!report.written) return;
  fmt::print("  {}, {} bytes, CRC-32 {:08x}:\n  {}\n\n", full_path(path), report.size_bytes, report.crc32,
             description(report.surface));
}

}  // namespace

QuantizationReport quantize_and_report(const Float32Model& model, const std::vector<TriangleMesh>& meshes,
                                       int sequences, const std::string& out, const ScenarioSettings& seen,
                                       const std::vector<EffectRanges>& effect_sets,
                                       const TargetSymmetry& symmetry, bool refuse_another_network) {
  ProgressBar bar("calibrating", "sequences", static_cast<std::uint64_t>(sequences));
  const QuantizationReport report =
      quantize_to_file(model, meshes, sequences, out, [&bar](std::uint64_t done) { bar.update(done); }, seen,
                       {symmetry, refuse_another_network, effect_sets, nullptr});
  bar.finish();
  print_report(report, out);
  return report;
}

}  // namespace tumblesight::sim


#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "sim/bench/network_bench.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/bench_images.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/host/program_files.hpp"
#include "sim/host/table.hpp"
#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "sim/model/model_file.hpp"
#include "sim/world/frame_renderer.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

constexpr std::uint64_t kSequences = 5;

struct BenchArguments {
  std::string target = default_target();
  std::string onnxruntime;
  std::string json;
};

std::vector<gnc::RangeImage> rendered_frames(const std::string& target) {
  const TriangleMesh mesh = target_by_name(target);
  const FlashLidar lidar(mesh);
  const FrameRenderer renderer(lidar, swath_m(mesh));
  std::vector<gnc::RangeImage> frames;
  for (std::uint64_t i = 0; i < kSequences; ++i) {
    const Sequence sequence = make_sequence({}, 1, i);
    for (std::uint32_t k = 0; k < sequence.frames.size(); ++k) {
      renderer.render(sequence, k, frames.emplace_back());
    }
  }
  return frames;
}

void print_measuring(const std::string& what) {
  print_message("  measuring " + what);
}

// The fixed-point model whose weights are read from `image`.
std::unique_ptr<FixedPointModel> fixed_point_model(const std::vector<std::uint8_t>& image) {
  auto model = std::make_unique<FixedPointModel>();
  const gnc::ModelStatus status = gnc::read_model_image<gnc::FixedPoint>(image.data(), image.size(), nullptr,
                                                                         model->header, model->weights);
  if (status != gnc::ModelStatus::kOk) throw std::runtime_error(gnc::to_string(status));
  return model;
}

// A runtime that is not installed is reported and left out; one whose outputs differ ends the run.
template <class Model>
void bench_one_runtime(const std::unique_ptr<Runtime>& runtime, const std::string& reason, const Model& model,
                       const std::vector<gnc::RangeImage>& frames, std::vector<BenchRow>& rows) {
  if (runtime == nullptr) {
    print_note("left out: " + reason);
    return;
  }
  print_measuring(runtime->name() + (runtime->is_int8() ? ", int8" : ", float32"));
  rows.push_back(bench_runtime(*runtime, model, frames));
}

void bench_runtimes(const BenchArguments& arguments, const BenchImages& images,
                    const std::vector<gnc::RangeImage>& frames, std::vector<BenchRow>& rows) {
  const std::unique_ptr<FixedPointModel> fixed = fixed_point_model(images.fixed);
  std::string reason;
  const auto add = [&](const std::unique_ptr<Runtime>& runtime, const auto& model) {
    bench_one_runtime(runtime, reason, model, frames, rows);
  };
  add(make_onnx_runtime_int8(*fixed, arguments.onnxruntime, reason), *fixed);
  add(make_onednn_int8(*fixed, reason), *fixed);
  add(make_onnx_runtime(*images.model, arguments.onnxruntime, reason), *images.model);
  add(make_libtorch(*images.model, reason), *images.model);
}

// A library that the user names is not left out.
void require_usable_library(const BenchArguments& arguments, const Float32Model& model) {
  std::string reason;
  if (arguments.onnxruntime.empty() || make_onnx_runtime(model, arguments.onnxruntime, reason)) return;
  throw std::runtime_error(
      fmt::format("--onnxruntime: {}; give libonnxruntime.so, or leave the option out", reason));
}

std::string table_of(const std::vector<BenchRow>& rows) {
  Table table({"", "numerics", "instructions", "median", "fastest", "GMAC/s", "of the peak"});
  std::string before;
  for (const BenchRow& row : rows) {
    const std::string group = row.numerics + row.isa;
    if (!before.empty() && group != before) table.rule();
    before = group;
    table.row({row.name, row.numerics, row.isa, fmt::format("{:.1f} us", row.median_us),
               fmt::format("{:.1f} us", row.min_us),
               row.macs > 0.0 ? fmt::format("{:.1f}", 1e-3 * row.macs / row.min_us) : "",
               row.share_of_peak ? fmt::format("{:.0f} %", 100.0 * *row.share_of_peak) : ""});
  }
  return table.text();
}

nlohmann::ordered_json json_of(const std::vector<BenchRow>& rows) {
  nlohmann::ordered_json json{{"rows", nlohmann::ordered_json::array()}};
  for (const BenchRow& row : rows) {
    nlohmann::ordered_json one{{"name", row.name},           {"numerics", row.numerics}, {"isa", row.isa},
                               {"median_us", row.median_us}, {"min_us", row.min_us},     {"macs", row.macs}};
    one["share_of_peak"] = row.share_of_peak ? nlohmann::ordered_json(*row.share_of_peak) : nullptr;
    json["rows"].push_back(one);
  }
  return json;
}

void bench(const BenchArguments& arguments) {
  const std::string model_folder = program_files().models;
  require_usable_files({{"--onnxruntime", arguments.onnxruntime},
                        {"--target (its model)", shipped_model_path(arguments.target)},
                        {"--target (its model)", shipped_model_path(arguments.target + ".float32")}},
                       {{"--json", arguments.json}});
  const BenchImages images = read_bench_images(model_folder, arguments.target);
  require_usable_library(arguments, *images.model);
  const std::vector<gnc::RangeImage> frames = rendered_frames(arguments.target);
  fmt::print("\n  {}, {:.1f} M multiply-accumulates per frame, one thread\n\n", arguments.target,
             1e-6 * static_cast<double>(gnc::kMacCount));
  std::fflush(stdout);
  std::vector<BenchRow> rows;
  for (const std::vector<std::uint8_t>& image : {images.fixed, images.float32}) {
    for (BenchRow& row : bench_numerics({image, frames}, print_measuring)) rows.push_back(std::move(row));
  }
  bench_runtimes(arguments, images, frames, rows);
  fmt::print("\n{}\n", table_of(rows));
  if (!arguments.json.empty()) write_file(arguments.json, json_of(rows).dump(2) + "\n");
}

}  // namespace

void add_bench_command(Command& app, const std::string&) {
  auto arguments = std::make_shared<BenchArguments>();
  Command command = add_verb(app, "bench");
  command.footer(
      "\nUses one thread, the shipped model in both numerics and every instruction set of\n"
      "this processor. A step goes from ranges to quaternion. The other runtimes run\n"
      "the network alone: ONNX Runtime and LibTorch in float32, ONNX Runtime and\n"
      "oneDNN with the CNN in int8. The peak is measured with the same\n"
      "multiply-accumulate instructions and no memory access. The share counts the\n"
      "multiplications of a direct convolution; with Winograd's filter, which needs\n"
      "fewer, it may exceed 100 %.\n\n"
      "ONNX Runtime is measured if its library is installed:\n"
      "  npm install --prefix build --ignore-scripts onnxruntime-node\n");
  add_target_option(command, arguments->target, TargetChoice::kShipped);
  command
      .add_option(
          "--onnxruntime", arguments->onnxruntime,
          "libonnxruntime.so [that of onnxruntime-node in build/node_modules, otherwise the system's]")
      ->check(existing_file())
      ->type_name("FILE");
  add_json_option(command, arguments->json);
  command.callback([arguments] {
    // Without a slash it would be looked for among the system's libraries.
    if (!arguments->onnxruntime.empty()) arguments->onnxruntime = full_path(arguments->onnxruntime);
    bench(*arguments);
  });
}

}  // namespace tumblesight::sim

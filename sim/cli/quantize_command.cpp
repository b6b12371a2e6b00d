
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>

#include "sim/cli/arguments.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/mission_arguments.hpp"
#include "sim/cli/quantize_and_report.hpp"
#include "sim/cli/symmetry_arguments.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/host/progress.hpp"
#include "sim/host/text.hpp"
#include "sim/host/write_file.hpp"
#include "sim/quantization/dequantize.hpp"
#include "sim/quantization/quantize_file.hpp"
#include "sim/surface/surface_samples.hpp"
#include "sim/surface/target_surface.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kSizeTolerance = 0.02;  // as for the swath of a mesh that is evaluated
// Of the points of a surface. Between the shipped meshes and NASA's of the same spacecraft it is below 0.01,
// and with the other axis up above 0.44.
constexpr double kMostUnlike = 0.25;

struct QuantizeArguments {
  std::string model;
  std::string out;
  MeshArguments meshes;
  Effects effects;
  std::vector<EffectRanges> effect_sets;
  TargetSymmetry symmetry;
  int sequences = kCalibrationSequences;
  SensorArguments sensor;
  bool surface_only = false;
  bool to_float32 = false;
  std::string target;  // of --mission
  std::optional<Mission> mission;
};

// near.float32.tsm -> near.tsm; anything else.tsm -> else.fixed.tsm
std::string default_out(const std::string& model) {
  const std::string stem = model_stem(model);
  return stem + (model == stem + ".float32.tsm" ? ".tsm" : ".fixed.tsm");
}

// The image that is written is for the sensor of the one that is read. `written` is empty if the description
// of that sensor need not be written: there is none, or it is beside the new image already.
struct SensorFiles {
  std::string read;
  std::string written;
};

// Throws std::runtime_error if the description cannot be read, or if that of another image would stand beside
// the new one.
SensorFiles sensor_files(const QuantizeArguments& arguments) {
  const std::string read = sensor_file_of(arguments.model), beside = sensor_file_of(arguments.out);
  std::error_code error;
  if (is_same_file(read, beside)) return {read, {}};
  if (std::filesystem::exists(read, error)) {
    (void)sensor_named(read);
    return {read, beside};
  }
  if (!std::filesystem::exists(beside, error)) return {};
  throw std::runtime_error(fmt::format(
      "'{}' says for which sensor an earlier image of this name was trained, and '{}' has no such "
      "file; remove it, or give another --out",
      beside, arguments.model));
}

SensorFiles require_usable_files(const QuantizeArguments& arguments) {
  const SensorFiles sensor = sensor_files(arguments);
  OptionFiles read = files_read(arguments.meshes, arguments.sensor);
  read.push_back({"--model", arguments.model});
  read.push_back({"--model (its sensor)", sensor.read});
  require_usable_files(read, {{"--out", arguments.out}, {"--out (its sensor)", sensor.written}});
  return sensor;
}

void copy_sensor_file(const SensorFiles& files) {
  if (!files.written.empty()) write_file(files.written, to_json(sensor_named(files.read)));
}

// With the surface of another body, or of one in another unit, the check of an attitude refuses every one or
// none. Empty if the mesh has the size of the one that the network was trained for.
std::string fault_of_size(const TriangleMesh& mesh, const gnc::ModelHeader& header) {
  const gnc::DepthProjection& network = header.projection;
  const gnc::DepthProjection found = projection_of(mesh);
  const auto agree = [](std::uint32_t one, std::uint32_t other) {
    return std::abs(static_cast<double>(one) - other) <= kSizeTolerance * other;
  };
  if (agree(found.target_radius_mm, network.target_radius_mm) && agree(found.swath_mm, network.swath_mm))
    return {};
  return fmt::format(
      "mesh {} has a radius of {:.3f} m and a swath of {:.3f} m, "
      "and the network was trained for {:.3f} m and {:.3f} m; give the mesh of its target, {}, in "
      "metres (--mesh-scale)",
      mesh.name, 1e-3 * found.target_radius_mm, 1e-3 * found.swath_mm, 1e-3 * network.target_radius_mm,
      1e-3 * network.swath_mm, header.target.data());
}

// With other axes than those of the network, the check of an attitude refuses every one. Empty if the mesh
// fits the surface that the image has, or if it has none.
std::string fault_of_axes(const QuantizeArguments& arguments, const TriangleMesh& mesh,
                          const gnc::SurfaceModel& found) {
  const std::vector<std::uint8_t> image = read_model_bytes(arguments.model);
  const gnc::SurfaceModel known = gnc::surface_of<gnc::FixedPoint>(image.data());
  const double unlike = unlike_share(known, found);
  if (unlike <= kMostUnlike) return {};
  const bool is_y = arguments.meshes.mesh_up == "y";
  const bool is_file = arguments.meshes.meshes.front() != kParametricMesh;
  // From the axes of a file with the one up to those with the other.
  const double angle_rad = is_y ? -kPi / 2.0 : kPi / 2.0;
  const Eigen::AngleAxisd turn(angle_rad, Eigen::Vector3d::UnitX());
  const bool fits_turned = is_file && unlike_share(known, found, turn.toRotationMatrix()) <= kMostUnlike;
  return fmt::format(
      "mesh {} does not fit the surface in model image '{}': {:.0f} % of the points are farther than a tenth "
      "of the radius away; {}. If the surface in the image is the wrong one, make the image anew from the "
      "one in float32 (tumblesight quantize without --surface-only)",
      mesh.name, arguments.model, 100.0 * unlike,
      fits_turned ? fmt::format("with the other axis up it fits: give --mesh-up {}", is_y ? "z" : "y")
                  : "give the mesh of its target, with the axes of the mesh that the network was trained on "
                    "(--mesh-up)");
}

void require_the_missions_target(const QuantizeArguments& arguments, const std::string& of_image) {
  if (!arguments.mission || arguments.target == of_image) return;
  throw std::invalid_argument(fmt::format("model image '{}' is of {}, and the mission '{}' of {}",
                                          arguments.model, of_image, arguments.mission->file,
                                          arguments.target));
}

// Writes the image `--model` with the surface of the mesh.
void replace_surface(const QuantizeArguments& arguments) {
  if (arguments.meshes.meshes.size() > 1)
    throw ArgumentFault("--surface-only", "takes the surface of one mesh; give one --mesh");
  if (!arguments.effect_sets.empty())
    throw ArgumentFault("--surface-only", "renders no frames; leave --effect-set out");
  if (!arguments.symmetry.is_none())
    throw ArgumentFault("--surface-only", "compares no attitudes; leave --symmetry out");
  const SensorFiles sensor = require_usable_files(arguments);
  const gnc::ModelHeader header = read_fixed_point_header(arguments.model);
  require_the_missions_target(arguments, header.target.data());
  const TriangleMesh mesh = load_meshes(arguments.meshes, header.target.data()).front();
  const std::string fault_of_mesh = fault_of_size(mesh, header);
  if (!fault_of_mesh.empty()) throw std::invalid_argument(fault_of_mesh);
  const SurfaceSections surface = target_surface(mesh, 1e-3 * header.projection.target_radius_mm);
  const std::string fault_of_fit = fault_of_axes(arguments, mesh, gnc::SurfaceModel(surface.points.data()));
  if (!fault_of_fit.empty()) throw std::invalid_argument(fault_of_fit);
  const std::uint32_t crc32 = write_with_surface(arguments.model, surface, arguments.out);
  copy_sensor_file(sensor);
  fmt::print("  {}, CRC-32 {:08x}:\n  {}\n", full_path(arguments.out), crc32, description(surface));
}

// All others are of the calibration or of the surface, and would have no effect.
void require_only_files(const Command& command) {
  const std::set<std::string> allowed{"--to-float32", "--model", "--out"};
  for (const CommandOption option : command.get_options()) {
    if (option->count() > 0 && allowed.count(option->get_name()) == 0)
      throw ArgumentFault("--to-float32", fmt::format("takes no {}; leave it out", option->get_name()));
  }
}

// Writes the fixed-point image `--model` in float32.
void write_float32(const QuantizeArguments& arguments) {
  const SensorFiles sensor = require_usable_files(arguments);
  const auto model = dequantized_model(arguments.model);
  const std::uint32_t crc32 = write_model_file<gnc::Float32>(arguments.out, model->header, model->weights);
  copy_sensor_file(sensor);
  fmt::print("  {}, {} bytes, CRC-32 {:08x}\n", full_path(arguments.out), gnc::kModelImageSize<gnc::Float32>,
             crc32);
}

void quantize_file(QuantizeArguments arguments) {
  if (arguments.to_float32) {
    write_float32(arguments);
    return;
  }
  if (arguments.surface_only) {
    replace_surface(arguments);
    return;
  }
  if (arguments.effect_sets.empty()) arguments.effect_sets = {arguments.effects};
  for (const EffectRanges& effects : arguments.effect_sets) {
    require_the_target(effects.high);
    require_whole_scans("--effect", effects.high, arguments.sensor.sensor);
  }
  if (arguments.out.empty()) arguments.out = default_out(arguments.model);
  const SensorFiles sensor = require_usable_files(arguments);
  const auto model = read_float32_model(arguments.model);
  require_the_missions_target(arguments, model->header.target.data());
  if (arguments.mission && arguments.symmetry.is_none())
    arguments.symmetry = target_symmetry_from(arguments.mission->symmetry);
  std::vector<std::string> notes{check_sensor_of_model(arguments.model, arguments.sensor.sensor)};
  ScenarioSettings seen = seen_by(arguments.sensor, 1e-3 * model->header.projection.swath_mm, notes);
  const std::vector<TriangleMesh> meshes = load_meshes(arguments.meshes, model->header.target.data());
  notes.push_back(fault_of_size(meshes.front(), model->header));
  for (const std::string& note : notes) {
    if (!note.empty()) print_note(note);
  }
  print_sensor(arguments.sensor.sensor, seen.ranges);
  const QuantizationReport report =
      quantize_and_report(*model, meshes, arguments.sequences, arguments.out, seen, arguments.effect_sets,
                          arguments.symmetry, true);
  if (!report.written) {
    std::fflush(stdout);
    fmt::print(
        stderr,
        "tumblesight: the attitudes in fixed point are {:.1f}° (mean) from those in float32, more than "
        "{:g}°; {} is not written. A network differs that much on frames unlike those it was trained on: "
        "give the meshes, axes and unit (--mesh, --mesh-up, --mesh-scale), the sensor and the effects of "
        "its training; its target is {}\n",
        report.difference.mean_deg, kMostDifference_deg, arguments.out, model->header.target.data());
    throw Exit(kOfNoUse);
  }
  copy_sensor_file(sensor);
}

constexpr const char* kFooter =
    "\nWeights have 8 bits and a scale per channel, activations have 8 or 16 bits.\n"
    "The scales are chosen on rendered sequences. --effect, --effect-set: those that\n"
    "the network was trained with. The table shows the quantization error of each\n"
    "layer. The first mesh gives the surface, as points and as triangles, by which\n"
    "the flight program judges what a frame shows. --surface-only replaces that\n"
    "surface in an image that is in fixed point already, also in one of format\n"
    "version 3 or 4. --to-float32 goes the other way, for a network of which only\n"
    "the image in fixed point is left. The float32 image computes the same, without\n"
    "the rounding of activations, and training can start from it. The sensor's\n"
    "description beside --model is copied beside --out.\n\n"
    "The exit status is 0, 1 if a file failed or the mesh does not fit, 2 for wrong\n"
    "arguments, and 4 if the attitudes in fixed point differ from those in float32 by\n"
    "more than 5° on average; then no image is written.\n\n"
    "Example\n"
    "  tumblesight quantize --model out/near/near_shoemaker.float32.tsm \\\n"
    "      --mesh parametric --mesh near.stl\n\n"
    "Example: the surface of your CAD file for an image that ships\n"
    "  tumblesight quantize --surface-only --model fsw/models/near_shoemaker.tsm \\\n"
    "      --mesh near.stl --out near.tsm\n\n"
    "Example: a start for training from an image that ships\n"
    "  tumblesight quantize --to-float32 --model fsw/models/magellan.tsm \\\n"
    "      --out magellan.float32.tsm\n";

void add_options_without_calibration(Command& command, QuantizeArguments& arguments) {
  CommandOption surface =
      command.add_flag("--surface-only", arguments.surface_only,
                       "--model is in fixed point: keep its weights, and replace its surface by that of "
                       "--mesh, which must have its size");
  surface->needs(command.get_option("--out"));
  for (const char* of_calibration : {"--effect", "--sensor", "--range", "--sequences"})
    surface->excludes(command.get_option(of_calibration));
  command
      .add_flag("--to-float32", arguments.to_float32,
                "--model is in fixed point: write the float32 image of the same weights; takes no options "
                "but --model and --out")
      ->needs(command.get_option("--out"));
}

}  // namespace

void add_quantize_command(Command& app, const std::string&) {
  auto arguments = std::make_shared<QuantizeArguments>();
  Command command = add_verb(app, "quantize");
  command.footer(kFooter);
  add_float32_model_option(command, arguments->model);
  CommandOption model = command.get_option("--model");
  model->description(model->get_description() +
                     "; with --surface-only or --to-float32: a model image in fixed point");
  command
      .add_option("--out", arguments->out,
                  "model image to write [--model without .float32; --surface-only has no default, nor has "
                  "--to-float32]")
      ->check(file_path())
      ->type_name("FILE");
  add_mesh_options(command, arguments->meshes);
  add_mission_option(command, arguments->target, arguments->meshes, arguments->sensor, arguments->mission);
  add_effect_option(command, arguments->effects);
  add_effect_set_option(command, arguments->effect_sets);
  add_sensor_options(command, arguments->sensor);
  add_symmetry_option(command, arguments->symmetry);
  limit_whole_number(command.add_option("--sequences", arguments->sequences,
                                        "sequences of ten frames to render for calibration"),
                     10, 10'000)
      ->type_name("N")
      ->capture_default_str();
  add_options_without_calibration(command, *arguments);
  command.callback([command, arguments] {
    if (arguments->to_float32) require_only_files(command);
    quantize_file(*arguments);
  });
}

}  // namespace tumblesight::sim

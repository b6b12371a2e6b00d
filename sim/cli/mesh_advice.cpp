#include "sim/cli/mesh_advice.hpp"

#include <fmt/format.h>

#include <cmath>

#include "sim/evaluation/chance.hpp"
#include "sim/host/text.hpp"
#include "sim/world/math/angles.hpp"
#include "sim/world/target/targets.hpp"

namespace tumblesight::sim {
namespace {

// By chance, two turns are within 20 degrees of each other in 0.2 % of the cases.
constexpr double kShareOfACommonTurn = 0.4;
constexpr std::size_t kFewestForACommonTurn = 5;
constexpr double kAboutAnAxis = 0.97;  // cosine
constexpr double kQuarterTurn_deg = 90.0;
constexpr std::size_t kWidth = 78;

std::string point(const std::string& text) {
  return paragraph("- " + text, "    ");
}

double angle_deg(const CommonTurn& common) {
  return kDegPerRad * common.turn.angle();
}

std::string axis_text(const Eigen::Vector3d& axis) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis[i]) > kAboutAnAxis) return fmt::format("{}{}", axis[i] < 0.0 ? "-" : "", "xyz"[i]);
  }
  return fmt::format("({:.1f}, {:.1f}, {:.1f})", axis.x(), axis.y(), axis.z());
}

bool is_that_of_mesh_up(const CommonTurn& common) {
  return std::abs(common.turn.axis().x()) > kAboutAnAxis &&
         std::abs(angle_deg(common) - kQuarterTurn_deg) <= kWrong_deg;
}

std::string turned(const ScenarioArguments& arguments, const CommonTurn& common) {
  const std::string remedy =
      is_that_of_mesh_up(common)
          ? fmt::format("Try --mesh-up {}.", arguments.mesh_up == "y" ? "z" : "y")
          : "Turn the mesh in the modelling tool to the axes of the mesh that the network was trained on.";
  return paragraph(fmt::format(
      "{:.0f} % of them are off by the same turn, {:.0f}° about the axis {} of the target: the mesh has "
      "other axes than the one that the network was trained on. {}",
      100.0 * common.share, angle_deg(common), axis_text(common.turn.axis()), remedy));
}

std::string likely_causes_without_a_mesh() {
  return paragraph("Likely causes:") +
         point(
             "a network that was not trained, or not for long enough; docs/training.md shows how to train "
             "one") +
         point("disturbances, effects, a sensor or ranges that it was not trained for") +
         point("a surface that looks the same from several sides; --symmetry tells of it");
}

std::string likely_causes(const ScenarioArguments& arguments, const Swaths& swaths) {
  return paragraph("Likely causes:") +
         point(
             "another spacecraft: a network knows only the one that it was trained for; docs/training.md "
             "shows how to train one for this mesh") +
         point(fmt::format("the axes: is --mesh-up {} right?", arguments.mesh_up)) +
         point(fmt::format(
             "the unit: the mesh needs a swath of {:.2f} m, and the network was trained for {:.2f} "
             "m; is --mesh-scale {:g} right?",
             swaths.mesh_m, swaths.network_m, arguments.mesh_scale)) +
         point("a surface that looks the same from several sides; --symmetry tells of it");
}

}  // namespace

std::string paragraph(const std::string& text, const std::string& further) {
  std::string indented = "  ";
  for (const char c : wrapped(text, kWidth - further.size())) {
    indented += c;
    if (c == '\n') indented += further;
  }
  return indented + "\n";
}

std::string mesh_advice(const ScenarioArguments& arguments, const Swaths& swaths, const ErrorSummary& last,
                        const CommonTurn& common) {
  if (!is_mostly_wrong(last)) return {};
  if (arguments.mesh.empty() || arguments.mesh == kParametricMesh) return likely_causes_without_a_mesh();
  const bool is_turned = last.count >= kFewestForACommonTurn && common.share >= kShareOfACommonTurn &&
                         angle_deg(common) > kWrong_deg;
  return is_turned ? turned(arguments, common) : likely_causes(arguments, swaths);
}

}  // namespace tumblesight::sim

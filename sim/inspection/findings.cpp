#include "sim/inspection/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>

#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

constexpr double kAlongAnAxis = 0.999;  // cosine
constexpr double kNearAnAxis = 0.98;
constexpr double kClearly = 3.0;       // less symmetric: by this factor
constexpr double kFarOrigin = 0.25;    // distance of the centre over the radius
constexpr double kWastedRadius = 1.2;  // radius about the origin over that about the centre
constexpr double kThinReach = 1.5;     // radius over that of 95 % of the surface
constexpr std::size_t kFewTriangles = 100;

// "12.3 mm" to "21810 m".
std::string length_text(double length_m) {
  if (length_m < 0.1) return fmt::format("{:.3g} mm", 1e3 * length_m);
  return length_m < 100.0 ? fmt::format("{:.3g} m", length_m) : fmt::format("{:.0f} m", length_m);
}

std::string area_text(double area_m2) {
  return fmt::format("{:.4g} m2", area_m2);
}

double percent(double part, double whole) {
  return 100.0 * part / whole;
}

class Findings {
 public:
  Findings(const std::string& file, const MeshInspection& found, const MeshFileOptions& options)
      : found_(found), options_(options) {
    ending_ = std::filesystem::path(file).extension().string();
    std::transform(ending_.begin(), ending_.end(), ending_.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  }

  std::vector<Finding> all() {
    size();
    unit();
    roundness();
    symmetry();
    up_axis();
    strays();
    origin();
    thin_reach();
    few_triangles();
    hiding();
    marker();
    notes();
    std::stable_sort(list_.begin(), list_.end(),
                     [](const Finding& a, const Finding& b) { return a.severity < b.severity; });
    return list_;
  }

 private:
  void add(const char* key, Severity severity, std::string text, std::string remedy = {}) {
    list_.push_back({key, severity, std::move(text), std::move(remedy)});
  }

  void size() {
    if (found_.radius_m < kMinMeshRadius_m || found_.radius_m > kMaxMeshRadius_m)
      add("size", Severity::kFault,
          fmt::format("The radius is {}. The tool takes targets of {:g} to {:g} m: one that is {:g} m across "
                      "just fits the widest view of the sensor.",
                      length_text(found_.radius_m), kMinMeshRadius_m, kMaxMeshRadius_m,
                      2.0 * kMaxMeshRadius_m),
          found_.strays.empty()
              ? "Give the unit of the file with --mesh-scale. A target that is really so large cannot "
                "be used."
              : "Remove the parts that lie far away with --fix, or give the unit with --mesh-scale.");
  }

  // Whether the size is plausible as it stands.
  bool is_plausible() const {
    return found_.centred_radius_m >= kSmallestPlausibleRadius_m &&
           found_.centred_radius_m <= kLargestPlausibleRadius_m;
  }

  void unit() {
    if (is_plausible()) return;
    std::string sizes;
    for (const Unit& unit : found_.likely_units) {
      sizes +=
          fmt::format("{}in {} (--mesh-scale {:g}) it is {}", sizes.empty() ? "" : ", ", unit.name,
                      unit.length_m, length_text(unit.length_m * found_.centred_radius_m / options_.scale));
    }
    add("unit", Severity::kWarning,
        fmt::format("A radius of {} is unusual for a spacecraft: the unit of the file is perhaps not {:g} m.",
                    length_text(found_.centred_radius_m), options_.scale),
        sizes.empty() ? "Find out the unit of the file and give it in metres with --mesh-scale."
                      : "Compare with a known length, and give the right unit: " + sizes + ".");
  }

  void roundness() {
    if (found_.roundness == Roundness::kSphere)
      add("sphere", Severity::kFault,
          "The outer surface is a sphere: it looks the same at every attitude, and no network can tell it.",
          "Use a mesh with the parts that make a difference.");
    if (found_.roundness == Roundness::kAboutAnAxis)
      add("revolution", Severity::kFault,
          fmt::format("The outer surface is a body of revolution about {}: the attitude about this axis "
                      "cannot be told.",
                      axis_name(found_.round_axis_trf)),
          "Add the parts that make a difference, or expect errors of any size about this axis.");
  }

  // Of each axis the highest fold that counts; the axis that is most nearly symmetric first.
  void symmetry() {
    if (found_.roundness != Roundness::kNone) return;
    const SymmetryAxis* nearest = nullptr;
    for (const SymmetryAxis& axis : found_.symmetry.axes) {
      if (nearest == nullptr || axis.moved_m[best_fold(axis)] < nearest->moved_m[best_fold(*nearest)])
        nearest = &axis;
    }
    if (nearest == nullptr) return;
    const double radius_m = found_.centred_radius_m;
    const double least_m = nearest->moved_m[best_fold(*nearest)];
    if (least_m > kNearlySameSurface * radius_m) return;
    std::size_t fold = best_fold(*nearest);
    for (std::size_t i = 0; i < kFolds.size(); ++i) {
      const double limit_m = std::max(1.5 * least_m, kSameSurface * radius_m);
      if (kFolds[i] > kFolds[fold] && nearest->moved_m[i] <= limit_m) fold = i;
    }
    const double moved_m = nearest->moved_m[fold];
    const bool same = moved_m <= kSameSurface * radius_m;
    add("symmetry", same ? Severity::kFault : Severity::kWarning,
        fmt::format("After 1/{} of a turn about {} the outer surface is {} the same: it moves by {} "
                    "on average, {:.2f} % of the radius.",
                    kFolds[fold], axis_name(nearest->axis_trf), same ? "practically" : "nearly",
                    length_text(moved_m), percent(moved_m, radius_m)),
        same ? "These attitudes cannot be told apart. Add the parts that make a difference, if there are any."
             : "Small parts alone tell these attitudes apart: train longer, and expect errors of whole steps "
               "where they are hidden.");
  }

  bool is_gltf() const { return ending_ == ".gltf" || ending_ == ".glb"; }

  void up_axis() {
    if (is_gltf() && options_.up == MeshUp::kZ) {
      add("up", Severity::kWarning,
          "The file is glTF, whose up axis is y by its standard, and --mesh-up is z.",
          "Leave --mesh-up out, unless the pictures show that the file breaks the standard.");
      return;
    }
    const bool z_is_up = options_.up == MeshUp::kZ;
    const double about_y_m = least_moved_m(Eigen::Vector3d::UnitY());
    const double about_z_m = least_moved_m(Eigen::Vector3d::UnitZ());
    const double same_m = kSameSurface * found_.centred_radius_m;
    if (about_y_m > kNearlySameSurface * found_.centred_radius_m ||
        about_z_m <= kClearly * (about_y_m + same_m))
      return;
    add("up", is_gltf() ? Severity::kNote : Severity::kWarning,
        fmt::format("The surface is nearly symmetric about y of the target frame, and less so about its z: "
                    "spacecraft are usually modelled upright, so the up axis of the file may be {}.",
                    z_is_up ? "y" : "z"),
        fmt::format("Look at the six sides. If they lie down, give --mesh-up {}. Any choice works as long as "
                    "training, evaluation and flight have the same.",
                    z_is_up ? "y" : "z"));
  }

  // By the fold after which the surface is most nearly the same about an axis near this one.
  double least_moved_m(const Eigen::Vector3d& direction) const {
    double least_m = std::numeric_limits<double>::infinity();
    for (const SymmetryAxis& axis : found_.symmetry.axes) {
      if (std::abs(axis.axis_trf.dot(direction)) > kNearAnAxis)
        least_m = std::min(least_m, axis.moved_m[best_fold(axis)]);
    }
    return least_m;
  }

  void strays() {
    if (found_.strays.empty()) {
      if (found_.parts.size() > 1)
        add("apart", Severity::kNote,
            fmt::format("{} stand apart from the rest of the surface, within its radius.",
                        counted(found_.parts.size() - 1, "part")));
      return;
    }
    std::size_t triangles = 0;
    double area_m2 = 0.0;
    for (const std::size_t stray : found_.strays) {
      triangles += found_.parts[stray].triangles.size();
      area_m2 += found_.parts[stray].area_m2;
    }
    const std::string what = fmt::format("Detached from the rest: {} of {} ({:.2g} % of the area)",
                                         counted(found_.strays.size(), "part"),
                                         counted(triangles, "triangle"), percent(area_m2, found_.area_m2));
    const bool enlarge = found_.radius_m > found_.core_radius_m;  // false if the origin is far away
    add("strays", Severity::kWarning,
        enlarge
            ? fmt::format(
                  "{}. The radius grows from {} to {}: the target covers {:.0f} % of the width of the image, "
                  "and the rest of its resolution is lost.",
                  what, length_text(found_.core_radius_m), length_text(found_.radius_m),
                  percent(found_.core_radius_m, found_.radius_m))
            : what + ", more than three of the rest's radii away.",
        "If they are not of the spacecraft, --fix removes them.");
  }

  void origin() {
    const double off_m = found_.centre_distance_m();
    const bool wasted = found_.core_radius_m > kWastedRadius * found_.centred_radius_m;
    if (!wasted && off_m <= kFarOrigin * found_.centred_radius_m) return;
    add("origin", Severity::kWarning,
        fmt::format("The origin is {} from the centre of the outer surface. About the origin the radius "
                    "is {}, about the centre {}: {:.0f} % of the resolution is lost. The target turns about "
                    "its origin, which should be its centre of mass.",
                    length_text(off_m), length_text(found_.core_radius_m),
                    length_text(found_.centred_radius_m),
                    std::max(0.0, 100.0 - percent(found_.centred_radius_m, found_.core_radius_m))),
        fmt::format(
            "--fix OUT.stl --origin X,Y,Z, or origin = [X, Y, Z] in a mission, moves the origin to the "
            "centre of mass; the centre of the surface is at {:.2f},{:.2f},{:.2f}.",
            found_.symmetry.centre_trf_m.x(), found_.symmetry.centre_trf_m.y(),
            found_.symmetry.centre_trf_m.z()));
  }

  void thin_reach() {
    if (found_.centred_radius_m <= kThinReach * found_.radius_of_95_m) return;
    add("reach", Severity::kWarning,
        fmt::format("95 % of the outer surface lie within {} of its centre, and the rest reaches {}: the "
                    "body covers {:.0f} % of the width of the image.",
                    length_text(found_.radius_of_95_m), length_text(found_.centred_radius_m),
                    percent(found_.radius_of_95_m, found_.centred_radius_m)),
        "If thin booms or antennas are of little use for the sensor, remove their ends in the modelling "
        "tool.");
  }

  void few_triangles() {
    if (found_.triangles >= kFewTriangles) return;
    add("triangles", Severity::kWarning,
        fmt::format(
            "The surface has {} only: details that the sensor sees on the spacecraft are probably missing.",
            counted(found_.triangles, "triangle")),
        "Export the surface with its details.");
  }

  void hiding() {
    if (!found_.hiding) return;
    const HidingPart& part = *found_.hiding;
    const std::string triangles = counted(part.triangles.size(), "triangle");
    if (part.is_plane) {
      add("hidden", Severity::kWarning,
          fmt::format(
              "A plane that is {} wide ({}) lies below all the rest, as the ground of a scene: the sensor "
              "would see it, and nothing of the spacecraft from the other side.",
              length_text(part.width_m), triangles),
          "Remove it in the modelling tool, if it is not of the spacecraft.");
      return;
    }
    const char* what = !part.is_marker ? "A closed part"
                       : found_.marker_can_go()
                           ? "A cube about the origin, as exporters add it to mark the origin,"
                           : "A cube about the origin, the body or what an exporter marks the origin with,";
    const char* remedy = !part.is_marker
                             ? "Remove it in the modelling tool, if it is a marker or a backdrop and not the "
                               "hull of the spacecraft."
                         : found_.marker_can_go()
                             ? "--fix removes it. If it is the hull with all the equipment inside, use the "
                               "file as it is."
                             : "--fix keeps it, since it may be the body of the spacecraft. If it is not, "
                               "remove it in the modelling tool.";
    add(part.is_marker ? "marker" : "hidden", Severity::kWarning,
        fmt::format(
            "{} ({}, {} wide) stands around {:.0f} % of the surface of all other parts ({} of {}) and hides "
            "it: the sensor would see this part in place of the spacecraft.",
            what, triangles, length_text(part.width_m), 100.0 * part.hidden,
            area_text(part.hidden * part.rest_m2), area_text(part.rest_m2)),
        remedy);
  }

  void marker() {
    if (!found_.marker || (found_.hiding && found_.hiding->is_marker)) return;
    if (found_.marker_can_go()) {
      add("marker", Severity::kNote,
          fmt::format("A cube with a side of {} stands about the origin. Some exporters add such a cube "
                      "to mark it.",
                      length_text(found_.marker->side_m)),
          "--fix removes it.");
      return;
    }
    add("marker", Severity::kNote,
        fmt::format(
            "A cube with a side of {} stands about the origin and is {:.0f} % of the outer surface. It "
            "may be the body, or a cube that an exporter has added to mark the origin.",
            length_text(found_.marker->side_m), 100.0 * found_.marker->outer_share),
        "Look at the six sides. --fix keeps it; if it is not of the spacecraft, remove it in the modelling "
        "tool.");
  }

  void notes() {
    if (found_.left_out > 0)
      add("left_out", Severity::kNote,
          fmt::format("{} ({:.2g} %) without area left out: no ray hits them.",
                      counted(found_.left_out, "triangle"),
                      percent(static_cast<double>(found_.left_out),
                              static_cast<double>(found_.left_out + found_.triangles))));
    if (found_.repeated > 0)
      add("repeated", Severity::kNote,
          fmt::format("{} {} another one, perhaps for the two sides of a sheet. The sensor model sees both "
                      "sides of every triangle.",
                      counted(found_.repeated, "triangle"), found_.repeated == 1 ? "repeats" : "repeat"),
          "--fix leaves them out.");
    if (found_.edges.turned > 0)
      add("turned", Severity::kNote,
          fmt::format("At {} the two triangles turn opposite ways round, so some normals point inwards. The "
                      "sensor model sees both sides.",
                      counted(found_.edges.turned, "edge")));
    if (found_.edges.open > 0)
      add("open", Severity::kNote,
          fmt::format(
              "{} ({:.0f} %) are open: the surface is not closed. Rays that enter see its inner side; look "
              "in the pictures for sides that are missing.",
              counted(found_.edges.open, "edge"),
              percent(static_cast<double>(found_.edges.open), static_cast<double>(found_.edges.edges))));
  }

  const MeshInspection& found_;
  const MeshFileOptions& options_;
  std::string ending_;
  std::vector<Finding> list_;
};

}  // namespace

std::string axis_name(const Eigen::Vector3d& axis) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(axis[i]) > kAlongAnAxis) return std::string(axis[i] < 0.0 ? "-" : "") + "xyz"[i];
  }
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", axis.x(), axis.y(), axis.z());
}

std::vector<Finding> findings_of(const std::string& file, const MeshInspection& found,
                                 const MeshFileOptions& options) {
  return Findings(file, found, options).all();
}

}  // namespace tumblesight::sim

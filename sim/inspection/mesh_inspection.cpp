#include "sim/inspection/mesh_inspection.hpp"

#include <algorithm>
#include <cmath>

#include "sim/inspection/cleaned_mesh.hpp"
#include "sim/inspection/findings.hpp"
#include "sim/surface/outside_views.hpp"
#include "sim/world/target/panels.hpp"

namespace tumblesight::sim {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Eigen::Vector3f>;

// A facetted body of revolution moves a little with every turn.
constexpr double kRound = 0.01;        // of the radius
constexpr double kAboutOneAxis = 0.9;  // cosine

constexpr std::size_t kFewestPoints = 3;

// About its own centre: rays that are spread over the radius about an origin far away miss it. The sensor
// model sees at most 500 m; a mesh in millimetres is larger.
TriangleMesh of_radius_1(TriangleMesh mesh, const Vector3d& centre_trf_m, double radius_m) {
  for (Eigen::Vector3f& vertex : mesh.vertices_trf_m)
    vertex = ((vertex.cast<double>() - centre_trf_m) / radius_m).cast<float>();
  return mesh;
}

// A surface so thin that the rays miss it is judged by its corners and the middles of its triangles.
Points points_of(const TriangleMesh& mesh, const OuterSurface& outer) {
  if (outer.points_trf_m.size() >= kFewestPoints) return outer.points_trf_m;
  Points points = mesh.vertices_trf_m;
  for (const auto& [a, b, c] : mesh.triangles)
    points.push_back((mesh.vertices_trf_m[a] + mesh.vertices_trf_m[b] + mesh.vertices_trf_m[c]) / 3.0F);
  return points;
}

double radius_about(const TriangleMesh& mesh, const Vector3d& centre) {
  double radius_m = 0.0;
  for (const Eigen::Vector3f& vertex : mesh.vertices_trf_m)
    radius_m = std::max(radius_m, (vertex.cast<double>() - centre).norm());
  return radius_m;
}

Eigen::AlignedBox3d box_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices_trf_m) box.extend(vertex.cast<double>());
  return box;
}

double radius_of_share(const Points& points, const Vector3d& centre, double share) {
  std::vector<double> distances;
  for (const Eigen::Vector3f& point : points) distances.push_back((point.cast<double>() - centre).norm());
  const auto at =
      distances.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(distances.size() - 1));
  std::nth_element(distances.begin(), at, distances.end());
  return *at;
}

SurfaceSymmetry placed(SurfaceSymmetry symmetry, const Vector3d& centre_trf_m, double factor) {
  symmetry.centre_trf_m = centre_trf_m + factor * symmetry.centre_trf_m;
  symmetry.extent_m *= factor;
  for (SymmetryAxis& axis : symmetry.axes) {
    for (double& moved_m : axis.moved_m) moved_m *= factor;
    axis.any_turn_m *= factor;
  }
  return symmetry;
}

void set_roundness(MeshInspection& found) {
  std::vector<Vector3d> round;
  for (const SymmetryAxis& axis : found.symmetry.axes) {
    const double worst_m =
        std::max(axis.any_turn_m, *std::max_element(axis.moved_m.begin(), axis.moved_m.end()));
    if (worst_m <= kRound * found.centred_radius_m) round.push_back(axis.axis_trf);
  }
  if (round.empty()) return;
  found.round_axis_trf = round.front();
  const bool one_axis = std::all_of(round.begin(), round.end(), [&](const Vector3d& axis) {
    return std::abs(axis.dot(round.front())) > kAboutOneAxis;
  });
  found.roundness = one_axis ? Roundness::kAboutAnAxis : Roundness::kSphere;
}

// What the views from outside show of the mesh without its strays.
void look_from_outside(const TriangleMesh& core, MeshInspection& found) {
  const Vector3d centre_trf_m = box_of(core).center();
  const double radius_m = radius_about(core, centre_trf_m);
  const TriangleMesh unit = of_radius_1(core, centre_trf_m, radius_m);
  const Points points = points_of(unit, outer_surface(unit));
  const SurfaceSymmetry symmetry = symmetry_of(unit, points);
  found.radius_of_95_m = radius_m * radius_of_share(points, symmetry.centre_trf_m, 0.95);
  found.symmetry = placed(symmetry, centre_trf_m, radius_m);
  found.centred_radius_m =
      std::min({found.core_radius_m, radius_about(core, found.symmetry.centre_trf_m), radius_m});
  set_roundness(found);
}

void count(const TriangleMesh& mesh, MeshInspection& found) {
  found.triangles = mesh.triangles.size();
  found.left_out = mesh.left_out;
  const std::vector<std::uint8_t> repeated = repeated_triangles(mesh);
  found.repeated = static_cast<std::size_t>(std::count(repeated.begin(), repeated.end(), 1));
  found.shells = connected_parts(mesh).size();
  found.edges = edges_of(mesh);
  found.panels = find_panels(mesh).size();
  found.panels_are_named = !mesh.is_panel.empty();
}

// The gravest findings come first.
void add_what_was_not_read(const TriangleMesh& mesh, MeshInspection& found) {
  const auto note = std::find_if(found.findings.begin(), found.findings.end(),
                                 [](const Finding& finding) { return finding.severity == Severity::kNote; });
  std::vector<Finding> losses;
  for (const std::string& loss : mesh.losses) losses.push_back({"lost", Severity::kWarning, loss + ".", ""});
  found.findings.insert(note, losses.begin(), losses.end());
  for (const std::string& text : mesh.notes)
    found.findings.push_back({"not_read", Severity::kNote, text + ".", ""});
}

}  // namespace

std::size_t best_fold(const SymmetryAxis& axis) {
  return static_cast<std::size_t>(std::min_element(axis.moved_m.begin(), axis.moved_m.end()) -
                                  axis.moved_m.begin());
}

bool MeshInspection::marker_can_go() const {
  if (!marker) return false;
  const bool hides_most = hiding && hiding->is_marker && hiding->hidden > kHiddenByCover;
  return hides_most || marker->outer_share < kNoLoss;
}

MeshInspection inspect(const TriangleMesh& mesh, const MeshFileOptions& options) {
  MeshInspection found;
  count(mesh, found);
  found.box_trf_m = box_of(mesh);
  found.radius_m = mesh.radius_m();
  found.parts = separate_parts(mesh);
  for (const SeparatePart& part : found.parts) found.area_m2 += part.area_m2;
  found.strays = strays_of(found.parts);
  found.marker = marker_cube(mesh);
  found.hiding = hiding_part(mesh, found.marker);
  const TriangleMesh core = without(mesh, triangles_of_strays(found));
  found.core_radius_m = core.radius_m();
  if (found.marker) {
    const std::optional<MarkerCube> of_core = marker_cube(core);  // none: the marker is a stray
    found.marker->outer_share = of_core ? outer_share_of(core, *of_core) : 0.0;
  }
  look_from_outside(core, found);
  found.likely_units = likely_units(found.centred_radius_m / options.scale);
  found.findings = findings_of(mesh.name, found, options);
  add_what_was_not_read(mesh, found);
  return found;
}

}  // namespace tumblesight::sim

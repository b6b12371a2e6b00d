#include <cmath>
#include <iterator>

#include "sim/world/math/angles.hpp"
#include "sim/world/target/primitives.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {

namespace {

constexpr int kX = 0;
constexpr int kY = 1;

// The bus is a regular octagon with flats on +-x, +-y and the diagonals.
constexpr float kBusCorner = 0.647F;
constexpr float kBusTop_z = 0.885F;
constexpr float kBusBottom_z = -1.136F;

TriangleMesh bus() {
  TriangleMesh mesh = prism(regular_polygon(8, kBusCorner, kPi_f / 8.0F), kBusBottom_z, kBusTop_z);
  append(mesh, revolve({{0.642F, -1.137F},
                        {0.721F, -1.273F},
                        {0.722F, -1.323F},
                        {0.684F, -1.323F},
                        {0.684F, -1.273F},
                        {0.608F, -1.137F}},
                       32));
  return mesh;
}

// The faceted sunshield: eight corners on the bus and eight on the rim, rotated by half a side.
TriangleMesh sunshield() {
  const auto rim = [](float radius, float z) { return loop_at(regular_polygon(8, radius, 0.0F), z); };
  const auto foot = [](float radius, float z) {
    return loop_at(regular_polygon(8, radius, -kPi_f / 8.0F), z);
  };
  const Loop loops[] = {rim(1.250F, 1.219F), rim(1.259F, 1.234F), rim(1.250F, 1.250F),
                        rim(1.234F, 1.250F), rim(1.225F, 1.234F), rim(1.234F, 1.219F)};
  TriangleMesh mesh = band(loops[0], foot(0.656F, 0.885F));
  for (std::size_t i = 1; i < std::size(loops); ++i) {
    append(mesh, band(loops[i - 1], loops[i]));
  }
  append(mesh, band(loops[5], foot(0.645F, 0.889F)));
  // Spokes along the folds and rods around the foot.
  const Loop spoke_foot = foot(0.647F, 0.894F);
  const Loop spoke_end = rim(1.250F, 1.231F);
  for (std::size_t i = 0; i < spoke_foot.size(); ++i) {
    const std::size_t next = (i + 1) % spoke_foot.size();
    append(mesh, tube(spoke_foot[i], spoke_end[i], 0.017F, 0.017F, 6));
    append(mesh, tube(spoke_foot[next], spoke_end[i], 0.017F, 0.017F, 6));
    append(mesh, tube(spoke_foot[i], spoke_foot[next], 0.014F, 0.014F, 4));
  }
  return mesh;
}

// The slab that carries the feeds, leaning towards -x, and its legs.
const Eigen::Vector3f kFeedSlabNormal(0.924F, 0.0F, -0.383F);

TriangleMesh feed_structure() {
  // Outline in the slab's rear face: (y, height along the slab).
  const Outline outline = {{-0.316F, 0.000F}, {0.324F, 0.000F},  {0.466F, 0.375F},  {0.666F, 0.973F},
                           {0.653F, 1.014F},  {0.001F, 1.214F},  {-0.059F, 1.226F}, {-0.131F, 1.226F},
                           {-0.202F, 1.219F}, {-0.255F, 1.195F}, {-0.310F, 1.141F}, {-0.343F, 1.083F},
                           {-0.357F, 1.044F}, {-0.369F, 0.999F}, {-0.385F, 0.466F}};
  const Eigen::Isometry3f slab =
      frame_at({-0.672F, 0.0F, 1.161F}, Eigen::Vector3f::UnitY(), {0.383F, 0.0F, 0.924F});
  TriangleMesh mesh = placed(prism(outline, 0.0F, 0.468F), slab);
  const Eigen::Vector3f legs[][2] = {{{-0.058F, -0.359F, 1.517F}, {-0.242F, -0.594F, 0.895F}},
                                     {{-0.080F, -0.363F, 1.454F}, {0.251F, -0.592F, 0.894F}},
                                     {{-0.086F, 0.418F, 1.449F}, {-0.246F, 0.598F, 0.892F}},
                                     {{-0.120F, 0.435F, 1.348F}, {0.246F, 0.595F, 0.892F}}};
  for (const auto& leg : legs) {
    append(mesh, tube(leg[0], leg[1], 0.024F, 0.024F, 6));
  }
  // Launch struts towards the folded reflector, with their pads.
  const Eigen::Vector3f struts[][2] = {{{-0.279F, 0.635F, 2.078F}, {0.293F, 0.543F, 2.187F}},
                                       {{-0.276F, -0.347F, 2.086F}, {0.296F, -0.439F, 2.195F}},
                                       {{0.296F, 0.551F, 2.171F}, {0.135F, 0.141F, 2.008F}},
                                       {{0.314F, 0.542F, 2.198F}, {0.113F, 0.634F, 1.917F}},
                                       {{0.317F, -0.439F, 2.206F}, {0.116F, -0.348F, 1.926F}}};
  for (const auto& strut : struts) {
    append(mesh, tube(strut[0], strut[1], 0.020F, 0.020F, 6));
  }
  append(mesh,
         placed(box({0.097F, 0.083F, 0.055F}),
                frame_at({0.283F, -0.434F, 2.202F}, {0.843F, 0.039F, -0.536F}, Eigen::Vector3f::UnitY())));
  append(mesh,
         placed(box({0.097F, 0.083F, 0.049F}),
                frame_at({0.289F, 0.539F, 2.195F}, {0.845F, -0.049F, -0.532F}, Eigen::Vector3f::UnitY())));
  return mesh;
}

// The three receivers: in front of the slab (+x) a housing with a flat side, behind it the horn's round
// mouth.
TriangleMesh feeds() {
  const Outline housing = {{-0.109F, -0.138F}, {-0.055F, -0.165F}, {0.0F, -0.171F},   {0.055F, -0.165F},
                           {0.109F, -0.138F},  {0.168F, 0.0F},     {0.147F, 0.081F},  {0.125F, 0.099F},
                           {0.0F, 0.111F},     {-0.125F, 0.099F},  {-0.147F, 0.081F}, {-0.168F, 0.0F}};
  Outline collar;
  for (const Eigen::Vector2f& p : housing) {
    collar.push_back(1.072F * p);
  }
  TriangleMesh both_sections = prism(housing, -0.350F, 0.0F);
  append(both_sections, prism(collar, -0.564F, -0.350F));
  struct Feed {
    Eigen::Vector3f housing_end, housing_axis, housing_x;
    Eigen::Vector3f mouth, mouth_axis;
  };
  const Feed three[] = {{{0.6555F, -0.1057F, 1.7293F},
                         {0.9414F, -0.0468F, -0.3341F},
                         {0.0441F, 0.9989F, -0.0157F},
                         {-0.421F, -0.096F, 2.075F},
                         {-0.955F, 0.077F, 0.286F}},
                        {{0.4502F, -0.1380F, 1.2248F},
                         {0.9034F, -0.0415F, -0.4267F},
                         {-0.1735F, 0.8748F, -0.4524F},
                         {-0.595F, -0.136F, 1.653F},
                         {-0.877F, 0.074F, 0.474F}},
                        {{0.5294F, 0.2905F, 1.4161F},
                         {0.9040F, 0.0464F, -0.4251F},
                         {0.2667F, 0.7159F, 0.6452F},
                         {-0.513F, 0.291F, 1.851F},
                         {-0.917F, -0.127F, 0.379F}}};
  TriangleMesh mesh;
  for (const Feed& feed : three) {
    append(mesh, placed(both_sections,
                        frame_at(feed.housing_end, feed.housing_x, feed.housing_axis.cross(feed.housing_x))));
    Loop rim;
    Loop root;
    for (const Eigen::Vector3f& p : loop_at(regular_polygon(28, 0.2195F, 0.0F), 0.0F)) {
      rim.push_back(frame_along(feed.mouth, feed.mouth_axis) * p);
      root.push_back(rim.back() + 0.160F * kFeedSlabNormal);
    }
    append(mesh, cap(rim));
    append(mesh, band(rim, root));
  }
  return mesh;
}

// The reflector in its own frame: origin at its centre, z along the axis on its rear side, x and y so that
// the hinge lies at kReflectorHinge, in a bite of the rim. In front a shallow bowl, behind a tent from the
// round rim to a square top.
const Eigen::Vector3f kReflectorHinge(-0.762F, 0.755F, 0.104F);
constexpr float kRear_z = 0.035F;  // of the rim's rear edge

// The round part of the rim beyond the bite, at a radius and a height.
Loop beyond_bite(float radius, float z) {
  constexpr float kFrom = 144.5F * kPi_f / 180.0F;
  constexpr float kTo = 482.5F * kPi_f / 180.0F;
  constexpr int kSteps = 46;
  Loop chain;
  for (int i = 0; i <= kSteps; ++i) {
    const float angle = kFrom + (kTo - kFrom) * static_cast<float>(i) / kSteps;
    chain.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return chain;
}

TriangleMesh reflector_bowl() {
  TriangleMesh mesh = revolve({{0.0F, 0.053F},
                               {0.208F, 0.048F},
                               {0.417F, 0.038F},
                               {0.626F, 0.023F},
                               {0.835F, 0.002F},
                               {1.060F, -0.027F}},
                              46);
  const Loop chains[] = {beyond_bite(1.060F, -0.027F), beyond_bite(1.250F, -0.055F),
                         beyond_bite(1.252F, -0.045F), beyond_bite(1.233F, kRear_z),
                         beyond_bite(1.060F, kRear_z)};
  for (std::size_t i = 1; i < std::size(chains); ++i) {
    append(mesh, strip(chains[i - 1], chains[i]));
  }
  // The walls of the bite.
  append(mesh, cap({chains[0].front(), chains[1].front(), chains[3].front(), chains[4].front()}));
  append(mesh, cap({chains[0].back(), chains[1].back(), chains[3].back(), chains[4].back()}));
  append(mesh, cap({chains[0].front(), chains[4].front(), chains[4].back(), chains[0].back()}));
  append(mesh, cap({chains[4].front(), chains[4].back(), {-0.635F, 0.635F, kRear_z}}));
  return mesh;
}

TriangleMesh reflector_tent() {
  const Eigen::Vector3f top[4] = {{0.635F, 0.635F, 0.215F},
                                  {-0.635F, 0.635F, 0.215F},
                                  {-0.635F, -0.635F, 0.215F},
                                  {0.635F, -0.635F, 0.215F}};
  // Where the tent meets the rim, in the three quadrants from -x through -y to +y.
  const Eigen::Vector3f rim[] = {{-1.232F, 0.0F, kRear_z},    {-0.971F, -0.759F, kRear_z},
                                 {-0.578F, -1.089F, kRear_z}, {0.0F, -1.232F, kRear_z},
                                 {0.578F, -1.089F, kRear_z},  {0.971F, -0.759F, kRear_z},
                                 {1.232F, 0.0F, kRear_z},     {1.023F, 0.690F, kRear_z},
                                 {0.654F, 1.046F, kRear_z},   {0.0F, 1.233F, kRear_z}};
  TriangleMesh mesh = cap({top[0], top[1], top[2], top[3]});
  const int corner_of[] = {2, 2, 2, 3, 3, 3, 0, 0};
  for (std::size_t i = 0; i < std::size(corner_of); ++i) {
    append(mesh, cap({top[corner_of[i]], rim[i], rim[i + 1]}));
  }
  append(mesh, cap({top[1], top[2], rim[0]}));
  append(mesh, cap({top[2], top[3], rim[3]}));
  append(mesh, cap({top[3], top[0], rim[6]}));
  // The fourth quadrant is creased, and cut away at the bite.
  const Eigen::Vector3f crease_right(0.470F, 0.854F, 0.125F);
  const Eigen::Vector3f crease(0.0F, 0.948F, 0.114F);
  const Eigen::Vector3f wall_right(-0.657F, 0.947F, 0.160F);
  const Eigen::Vector3f wall_right_foot(-0.653F, 1.046F, kRear_z);
  const Eigen::Vector3f wall_left(-0.999F, 0.680F, 0.104F);
  const Eigen::Vector3f wall_left_foot(-1.022F, 0.690F, kRear_z);
  const Eigen::Vector3f wall_foot(-0.635F, 0.635F, kRear_z);
  for (const Loop& facet : {Loop{top[0], rim[8], crease_right}, Loop{crease_right, rim[8], rim[9]},
                            Loop{top[0], crease_right, crease}, Loop{crease, crease_right, rim[9]},
                            Loop{top[0], crease, wall_right}, Loop{top[0], wall_right, top[1]},
                            Loop{crease, rim[9], wall_right_foot}, Loop{crease, wall_right_foot, wall_right},
                            Loop{top[1], wall_right, wall_right_foot, wall_foot},
                            Loop{top[1], wall_foot, wall_left_foot, wall_left},
                            Loop{top[1], wall_left, rim[0]}, Loop{wall_left, wall_left_foot, rim[0]}}) {
    append(mesh, cap(facet));
  }
  return mesh;
}

TriangleMesh reflector() {
  TriangleMesh mesh = reflector_bowl();
  append(mesh, reflector_tent());
  return mesh;
}

// The boom, stowed, from its foot on -x to the hinge at the reflector's rim; it turns about its foot's axis.
const Eigen::Vector3f kBoomFoot(-0.717F, 0.0F, 1.209F);
const Eigen::Vector3f kBoomHinge(-0.584F, 0.755F, 2.773F);

TriangleMesh boom_foot() {
  TriangleMesh mesh = tube({-0.717F, -0.166F, 1.209F}, {-0.717F, 0.079F, 1.209F}, 0.067F, 0.067F, 12);
  append(mesh, with_mirror_image(
                   tube({-0.595F, 0.242F, 0.894F}, {-0.695F, 0.010F, 1.162F}, 0.022F, 0.022F, 6), kY));
  return mesh;
}

TriangleMesh boom() {
  TriangleMesh mesh = tube({-0.718F, -0.020F, 1.240F}, {-0.695F, 0.820F, 2.565F}, 0.047F, 0.047F, 8);
  append(mesh, tube({-0.695F, 0.820F, 2.582F}, {-0.598F, 0.820F, 2.752F}, 0.047F, 0.047F, 8));
  append(mesh, tube({-0.584F, 0.638F, 2.773F}, {-0.584F, 0.872F, 2.773F}, 0.059F, 0.059F, 12));
  return mesh;
}

constexpr float kPanelInner_y = 0.695F;  // faces of the stowed panel
constexpr float kPanelOuter_y = 0.751F;

// The panel on +y, stowed; the one on -y has two windows for the instruments behind it.
TriangleMesh solar_panel(bool with_windows) {
  const auto part = [](float x_from, float x_to, float z_from, float z_to) {
    return box_between({x_from, kPanelInner_y, z_from}, {x_to, kPanelOuter_y, z_to});
  };
  TriangleMesh mesh;
  // The edge is stepped below and has a notch above.
  for (const TriangleMesh& strip_of_panel :
       {part(0.297F, 0.648F, -1.193F, 0.727F), part(0.648F, 0.946F, -1.274F, 0.727F),
        part(0.946F, 1.000F, -0.977F, 0.727F)}) {
    append(mesh, with_mirror_image(strip_of_panel, kX));
  }
  if (with_windows) {
    append(mesh, part(-0.297F, 0.297F, 0.030F, 0.597F));
    append(mesh, part(-0.297F, 0.297F, -1.038F, -0.146F));
    append(mesh, part(-0.145F, 0.145F, -0.146F, 0.030F));
    append(mesh, with_mirror_image(part(0.258F, 0.297F, -0.146F, 0.030F), kX));
  } else {
    append(mesh, part(-0.297F, 0.297F, -1.038F, 0.597F));
  }
  mesh = as_panel(mesh);
  append(mesh, box_between({-0.085F, 0.691F, -1.041F}, {0.085F, 0.756F, -0.885F}));
  // Hold-down studs.
  const Eigen::Vector2f studs_xz[] = {
      {0.648F, 0.258F}, {0.648F, 0.113F}, {0.073F, -0.737F}, {0.276F, 0.264F}};
  for (const Eigen::Vector2f& stud : studs_xz) {
    append(mesh, with_mirror_image(tube({stud.x(), kPanelOuter_y, stud.y()}, {stud.x(), 0.812F, stud.y()},
                                        0.019F, 0.019F, 6),
                                   kX));
  }
  return mesh;
}

// The hinge fitting of a panel on the bus.
const Eigen::Vector3f kPanelHinge(0.0F, 0.676F, -1.084F);

TriangleMesh panel_hinges() {
  TriangleMesh one = box_between({-0.062F, 0.596F, -1.122F}, {-0.042F, 0.700F, -1.042F});
  append(one, box_between({0.042F, 0.596F, -1.122F}, {0.062F, 0.700F, -1.042F}));
  append(one, tube({-0.048F, 0.676F, -1.084F}, {0.050F, 0.676F, -1.084F}, 0.026F, 0.026F, 6));
  append(one, box_between({-0.026F, 0.660F, -1.090F}, {0.026F, 0.742F, -1.037F}));
  return with_mirror_image(one, kY);
}

Eigen::Isometry3f turned_about(const Eigen::Vector3f& point, const Eigen::Vector3f& axis, float angle_rad) {
  return Eigen::Translation3f(point) * Eigen::AngleAxisf(angle_rad, axis) * Eigen::Translation3f(-point);
}

// Both panels, each moved from its stowed position by `pose` or its mirror image.
TriangleMesh panels(const Eigen::Isometry3f& pose) {
  TriangleMesh mesh = placed(solar_panel(false), pose);
  append(mesh, mirrored(placed(solar_panel(true), pose), kY));
  return mesh;
}

TriangleMesh composed(const char* name, const Eigen::Isometry3f& panel_pose,
                      const Eigen::Isometry3f& boom_pose, const Eigen::Isometry3f& reflector_pose) {
  TriangleMesh mesh;
  mesh.name = name;
  for (const TriangleMesh& part : {bus(), sunshield(), feed_structure(), feeds(), boom_foot(), panel_hinges(),
                                   make_sacd_aquarius_equipment(), panels(panel_pose),
                                   placed(boom(), boom_pose), placed(reflector(), reflector_pose)}) {
    append(mesh, part);
  }
  return mesh;
}

}  // namespace

TriangleMesh make_sacd_aquarius_stowed() {
  const Eigen::Isometry3f reflector_pose =
      frame_at({0.0248F, 0.0F, 2.3030F}, {0.8667F, 0.0F, -0.4988F}, Eigen::Vector3f::UnitY());
  return composed("sacd_aquarius_stowed", Eigen::Isometry3f::Identity(), Eigen::Isometry3f::Identity(),
                  reflector_pose);
}

TriangleMesh make_sacd_aquarius() {
  constexpr float kQuarterTurn = kPi_f / 2.0F;
  constexpr float kBoomSwing =
      74.6F * kPi_f / 180.0F;  // moves the reflector's centre onto the horns' middle axis
  const Eigen::Isometry3f panel_pose = turned_about(kPanelHinge, Eigen::Vector3f::UnitX(), -kQuarterTurn);
  const Eigen::Isometry3f boom_pose = turned_about(kBoomFoot, Eigen::Vector3f::UnitY(), -kBoomSwing);
  // Rear side towards -x, the hinge at the boom's end.
  Eigen::Isometry3f reflector_pose =
      frame_at(Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ(), Eigen::Vector3f::UnitY());
  reflector_pose.translation() = boom_pose * kBoomHinge - reflector_pose.linear() * kReflectorHinge;
  return composed("sacd_aquarius", panel_pose, boom_pose, reflector_pose);
}

}  // namespace tumblesight::sim

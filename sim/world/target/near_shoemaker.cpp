#include <cmath>
#include <iterator>

#include "sim/world/math/angles.hpp"
#include "sim/world/target/primitives.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {

namespace {

constexpr float kQuarterTurn = kPi_f / 2.0F;
constexpr float kDiagonal = kPi_f / 4.0F;              // heading of the corner between +x and +y
constexpr float kOppositeDiagonal = 5.0F * kDiagonal;  // of the corner between -x and -y

// Body and decks. The body is a regular octagon with flats on +-x, +-y and the diagonals.
constexpr float kBodyFlat = 0.746F;  // distance of the flats from the axis
constexpr float kBodyAft_z = -0.922F;
constexpr float kBodyForward_z = 0.478F;
constexpr float kDeckHalf = 0.741F;
constexpr float kDeckChamfer = 0.113F;
constexpr float kDeckThickness = 0.051F;
constexpr float kAftDeck_z = -0.973F;  // outer faces of the decks
constexpr float kForwardDeck_z = 0.529F;

// The main thruster: a horn recessed in the flat between +x and +y, with the bell inside. Distances u are
// along the diagonal.
constexpr float kThruster_z = -0.222F;
constexpr float kHornTip_u = 0.335F;
constexpr float kHornMouth_u = 0.804F;
constexpr float kHornMouthRadius = 0.252F;
constexpr float kHornWall = 0.016F;

TriangleMesh diagonal_flat_with_hole(float half_edge) {
  const float slope = kHornMouthRadius / (kHornMouth_u - kHornTip_u);
  const float hole_radius = (kBodyFlat - kHornTip_u) * slope;
  const float top = kBodyForward_z;
  const float bottom = kBodyAft_z;
  const float mid = kThruster_z;
  // Rectangle and hole, both as eight points from the +v side upwards.
  const Outline rectangle_vz = {{half_edge, mid},  {half_edge, top},     {0.0F, top},    {-half_edge, top},
                                {-half_edge, mid}, {-half_edge, bottom}, {0.0F, bottom}, {half_edge, bottom}};
  const Outline hole = regular_polygon(8, hole_radius, 0.0F);
  Loop outer;
  Loop inner;
  for (std::size_t i = 0; i < hole.size(); ++i) {
    outer.emplace_back(kBodyFlat, rectangle_vz[i].x(), rectangle_vz[i].y());
    inner.emplace_back(kBodyFlat, hole[i].x(), mid + hole[i].y());
  }
  return placed(band(outer, inner), turned(kDiagonal));
}

TriangleMesh body() {
  const float half_edge = kBodyFlat * std::tan(kPi_f / 8.0F);
  TriangleMesh mesh;
  for (int side = 0; side < 8; ++side) {
    if (side == 1) {
      append(mesh, diagonal_flat_with_hole(half_edge));
      continue;
    }
    const Loop flat = {{kBodyFlat, -half_edge, kBodyAft_z},
                       {kBodyFlat, half_edge, kBodyAft_z},
                       {kBodyFlat, half_edge, kBodyForward_z},
                       {kBodyFlat, -half_edge, kBodyForward_z}};
    append(mesh, placed(cap(flat), turned(static_cast<float>(side) * kDiagonal)));
  }
  return mesh;
}

// The square decks. The forward one lacks the corners (+x,-y) and (-x,+y), the aft one (+x,+y) and (-x,-y).
TriangleMesh decks() {
  const float a = kDeckHalf;
  const float c = kDeckHalf - kDeckChamfer;
  const Outline forward = {{-a, -a}, {c, -a}, {a, -c}, {a, a}, {-c, a}, {-a, c}};
  const Outline aft = {{-a, -c}, {-c, -a}, {a, -a}, {a, c}, {c, a}, {-a, a}};
  TriangleMesh mesh = prism(forward, kForwardDeck_z - kDeckThickness, kForwardDeck_z);
  append(mesh, prism(aft, kAftDeck_z, kAftDeck_z + kDeckThickness));
  return mesh;
}

// The gussets between the body's diagonal flats and the corners of the decks, with a concave profile.
TriangleMesh gussets() {
  // Cross-sections from the body to the deck: height above the first, and the outline's points in order.
  struct Section {
    float height;
    Outline outline;
  };
  const Section sections[] = {
      {0.0F, {{0.712F, 0.343F}, {0.625F, 0.430F}, {0.528F, 0.528F}, {0.430F, 0.625F}, {0.343F, 0.712F}}},
      {0.037F, {{0.727F, 0.388F}, {0.642F, 0.473F}, {0.557F, 0.557F}, {0.473F, 0.642F}, {0.388F, 0.727F}}},
      {0.060F, {{0.720F, 0.454F}, {0.654F, 0.520F}, {0.587F, 0.587F}, {0.520F, 0.654F}, {0.454F, 0.720F}}},
      {0.077F, {{0.717F, 0.343F}, {0.719F, 0.530F}, {0.645F, 0.645F}, {0.530F, 0.719F}, {0.343F, 0.717F}}}};
  TriangleMesh corner;
  for (std::size_t i = 1; i < std::size(sections); ++i) {
    const Section& from = sections[i - 1];
    const Section& to = sections[i];
    const float first = from.height - sections[3].height;
    const float second = to.height - sections[3].height;
    append(corner,
           band(loop_at(from.outline, kBodyForward_z + first), loop_at(to.outline, kBodyForward_z + second)));
    append(corner, band(loop_at(from.outline, kBodyAft_z - first), loop_at(to.outline, kBodyAft_z - second)));
  }
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) {
    append(mesh, placed(corner, turned(static_cast<float>(i) * kQuarterTurn)));
  }
  return mesh;
}

// One solar panel on +x with its two brackets and their feet on the forward deck. The others are rotated
// copies.
TriangleMesh panels() {
  TriangleMesh one = as_panel(
      placed(box({1.827F, 1.219F, 0.019F}), Eigen::Isometry3f(Eigen::Translation3f(1.7335F, 0.0F, 0.7485F))));
  for (const float side : {-1.0F, 1.0F}) {
    // The arm rises from its foot and ends in a tongue under the panel; a window leaves two rails in its
    // middle.
    const Outline arm_low = {{0.672F, 0.628F}, {0.687F, 0.601F}, {0.769F, 0.652F}, {0.751F, 0.682F}};
    const Outline arm_middle = {{0.751F, 0.682F}, {0.769F, 0.652F}, {0.855F, 0.706F}, {0.836F, 0.735F}};
    const Outline arm_high = {{0.836F, 0.735F}, {0.855F, 0.706F}, {0.866F, 0.713F}, {0.847F, 0.743F}};
    const Outline tongue = {{0.847F, 0.713F}, {1.022F, 0.713F}, {1.022F, 0.743F}, {0.847F, 0.743F}};
    const Outline foot = {{0.664F, 0.529F}, {0.726F, 0.529F}, {0.726F, 0.600F}, {0.667F, 0.600F}};
    const Outline foot_head = {{0.669F, 0.600F}, {0.726F, 0.600F}, {0.726F, 0.645F}, {0.672F, 0.645F}};
    append(one, upright_prism(arm_low, 0.0F, side * 0.334F, side * 0.383F));
    append(one, upright_prism(arm_middle, 0.0F, side * 0.293F, side * 0.316F));
    append(one, upright_prism(arm_middle, 0.0F, side * 0.363F, side * 0.383F));
    append(one, upright_prism(arm_high, 0.0F, side * 0.293F, side * 0.383F));
    append(one, upright_prism(tongue, 0.0F, side * 0.293F, side * 0.383F));
    append(one, upright_prism(foot, 0.0F, side * 0.208F, side * 0.309F));
    append(one, upright_prism(foot_head, 0.0F, side * 0.183F, side * 0.335F));
  }
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) {
    append(mesh, placed(one, turned(static_cast<float>(i) * kQuarterTurn)));
  }
  return mesh;
}

// High-gain antenna: dish on a conical skirt, feed on a tripod, which breaks the four-fold symmetry.
TriangleMesh antenna() {
  const Outline dish = {{0.0F, 0.590F},   {0.106F, 0.590F}, {0.280F, 0.600F}, {0.453F, 0.630F},
                        {0.561F, 0.661F}, {0.659F, 0.707F}, {0.750F, 0.757F}, {0.750F, 0.720F},
                        {0.697F, 0.700F}, {0.641F, 0.680F}, {0.581F, 0.660F}, {0.499F, 0.630F},
                        {0.518F, 0.604F}, {0.684F, 0.529F}};
  const Outline feed = {{0.009F, 1.135F}, {0.027F, 1.150F}, {0.016F, 1.176F}, {0.052F, 1.176F},
                        {0.034F, 1.350F}, {0.034F, 1.400F}, {0.029F, 1.420F}, {0.0F, 1.432F}};
  TriangleMesh mesh = revolve(dish, 48);
  append(mesh, revolve(feed, 20));
  const Eigen::Vector3f legs[3][2] = {{{0.322F, 0.312F, 0.606F}, {0.027F, 0.023F, 1.176F}},
                                      {{-0.420F, 0.119F, 0.622F}, {-0.034F, 0.012F, 1.176F}},
                                      {{0.107F, -0.424F, 0.620F}, {0.007F, -0.035F, 1.176F}}};
  for (const auto& leg : legs) {
    append(mesh, tube(leg[0], leg[1], 0.012F, 0.012F, 6));
  }
  return mesh;
}

TriangleMesh adapter_ring() {
  const Outline profile = {{0.0F, -1.150F},   {0.403F, -1.150F}, {0.403F, -1.432F},
                           {0.444F, -1.432F}, {0.444F, -1.385F}, {0.430F, -1.375F},
                           {0.430F, -1.185F}, {0.444F, -1.175F}, {0.444F, -0.973F}};
  return revolve(profile, 24);
}

TriangleMesh main_thruster() {
  const float length = kHornMouth_u - kHornTip_u;
  const Outline horn = {
      {0.0F, 0.0F}, {kHornMouthRadius, length}, {kHornMouthRadius - kHornWall, length}, {0.0F, 0.02F}};
  const Outline bell = {{0.044F, 0.085F}, {0.046F, 0.145F}, {0.022F, 0.165F}, {0.061F, 0.205F},
                        {0.040F, 0.230F}, {0.105F, 0.325F}, {0.131F, 0.445F}, {0.147F, 0.585F},
                        {0.152F, 0.645F}, {0.137F, 0.665F}, {0.137F, 0.605F}, {0.090F, 0.325F},
                        {0.0F, 0.230F}};
  TriangleMesh along_z = revolve(horn, 8);
  append(along_z, revolve(bell, 24));
  const Eigen::Vector3f diagonal(std::cos(kDiagonal), std::sin(kDiagonal), 0.0F);
  return placed(along_z,
                frame_along(kHornTip_u * diagonal + kThruster_z * Eigen::Vector3f::UnitZ(), diagonal));
}

// A box that stands on a deck.
struct DeckBox {
  float x, y;           // centre
  float along, across;  // edges; `along` lies at yaw_deg from +x
  float yaw_deg;
  float z_from, z_to;
};

constexpr DeckBox kDeckBoxes[] = {
    // aft deck
    {0.578F, -0.229F, 0.202F, 0.202F, 0.0F, -1.113F, -0.973F},
    {0.578F, -0.229F, 0.222F, 0.222F, 0.0F, -1.133F, -1.113F},
    {0.598F, 0.203F, 0.175F, 0.175F, 45.0F, -1.096F, -0.973F},
    {-0.384F, 0.430F, 0.175F, 0.175F, 45.0F, -1.096F, -0.973F},
    {0.186F, 0.568F, 0.185F, 0.154F, 0.0F, -1.096F, -0.973F},
    {-0.081F, 0.568F, 0.140F, 0.154F, 0.0F, -1.096F, -0.973F},
    {-0.616F, 0.616F, 0.152F, 0.161F, -45.0F, -1.036F, -0.973F},
    {0.639F, -0.639F, 0.124F, 0.161F, -45.0F, -1.036F, -0.973F},
    {-0.148F, -0.567F, 0.181F, 0.181F, -45.0F, -1.013F, -0.973F},
    {-0.152F, -0.520F, 0.109F, 0.120F, -45.0F, -1.089F, -1.013F},
    {0.450F, -0.538F, 0.100F, 0.192F, -45.0F, -1.050F, -0.973F},
    // forward deck
    {0.635F, -0.634F, 0.097F, 0.132F, -45.0F, 0.529F, 0.613F},
    {-0.635F, 0.634F, 0.097F, 0.132F, 135.0F, 0.529F, 0.613F},
};

TriangleMesh deck_boxes() {
  TriangleMesh mesh;
  for (const DeckBox& b : kDeckBoxes) {
    const Eigen::Isometry3f pose =
        Eigen::Translation3f(b.x, b.y, (b.z_from + b.z_to) / 2.0F) * turned(b.yaw_deg * kPi_f / 180.0F);
    append(mesh, placed(box({b.along, b.across, b.z_to - b.z_from}), pose));
  }
  return mesh;
}

TriangleMesh aft_instruments() {
  TriangleMesh mesh;
  // Corner (-x,-y): a spectrometer housing with its tilted head and a sensor beside it, and its wedge-shaped
  // seat.
  append(mesh, upright_prism({{0.800F, -0.973F},
                              {0.990F, -0.975F},
                              {1.007F, -1.003F},
                              {0.953F, -1.080F},
                              {0.760F, -1.312F},
                              {0.620F, -1.197F}},
                             kOppositeDiagonal, -0.080F, 0.080F));
  append(mesh, upright_prism({{0.820F, -1.236F}, {0.870F, -1.276F}, {0.810F, -1.353F}, {0.760F, -1.312F}},
                             kOppositeDiagonal, -0.080F, 0.080F));
  append(mesh, upright_prism({{0.953F, -1.080F}, {0.972F, -1.102F}, {0.940F, -1.142F}, {0.915F, -1.120F}},
                             kOppositeDiagonal, -0.080F, 0.080F));
  append(mesh,
         upright_prism(
             {{0.595F, -1.290F}, {0.650F, -1.220F}, {0.730F, -1.290F}, {0.680F, -1.354F}, {0.645F, -1.354F}},
             kOppositeDiagonal, -0.050F, 0.050F));
  append(mesh, upright_prism({{0.755F, -1.276F}, {0.811F, -1.208F}, {0.709F, -1.125F}, {0.653F, -1.193F}},
                             kOppositeDiagonal, 0.078F, 0.146F));
  append(mesh, upright_prism({{0.425F, -0.973F}, {0.425F, -1.029F}, {0.620F, -1.197F}, {0.800F, -0.973F}},
                             kOppositeDiagonal, -0.080F, 0.080F));
  // Corner (+x,+y): a telescope with a flange, on a wedge.
  const Eigen::Vector3f u(std::cos(kDiagonal), std::sin(kDiagonal), 0.0F);
  const Eigen::Vector3f z = Eigen::Vector3f::UnitZ();
  const Eigen::Vector3f telescope = 0.838F * u - 1.035F * z;
  const Outline barrel = {
      {0.062F, 0.0F}, {0.062F, 0.345F}, {0.050F, 0.345F}, {0.050F, 0.100F}, {0.0F, 0.100F}};
  append(mesh, placed(revolve(barrel, 16), frame_along(telescope, 0.270F * u - 0.215F * z)));
  append(mesh, tube(0.927F * u - 1.109F * z, 0.943F * u - 1.121F * z, 0.115F, 0.115F, 16));
  append(mesh, upright_prism({{0.629F, -0.973F}, {0.784F, -1.094F}, {0.880F, -0.973F}}, kDiagonal, -0.128F,
                             0.128F));
  // On -x: the camera, its optics towards the corner (-x,-y).
  constexpr float kCameraHeading = 46.2F * kPi_f / 180.0F;
  append(mesh, upright_prism({{-0.376F, -0.973F},
                              {-0.368F, -1.065F},
                              {-0.282F, -1.104F},
                              {-0.180F, -1.104F},
                              {-0.150F, -1.035F},
                              {-0.150F, -0.973F}},
                             kCameraHeading, 0.441F, 0.591F));
  append(mesh, tube({-0.635F, 0.083F, -1.029F}, {-0.723F, -0.005F, -1.029F}, 0.048F, 0.048F, 12));
  // On -y: a housing on a six-cornered outline, and a small telescope beside it.
  append(mesh, prism({{0.086F, -0.636F},
                      {0.177F, -0.699F},
                      {0.222F, -0.677F},
                      {0.285F, -0.545F},
                      {0.195F, -0.481F},
                      {0.090F, -0.584F}},
                     -1.143F, -0.973F));
  append(mesh, tube({-0.197F, -0.572F, -1.047F}, {-0.255F, -0.630F, -1.047F}, 0.030F, 0.030F, 12));
  append(mesh, tube({0.580F, -0.056F, -1.039F}, {0.580F, -0.129F, -1.039F}, 0.040F, 0.040F, 12));
  // A low-gain antenna.
  append(mesh, tube({-0.496F, -0.065F, -0.973F}, {-0.496F, -0.065F, -1.215F}, 0.040F, 0.040F, 12));
  append(mesh, tube({-0.496F, -0.065F, -1.215F}, {-0.496F, -0.065F, -1.246F}, 0.040F, 0.012F, 12));
  return mesh;
}

TriangleMesh forward_corners() {
  TriangleMesh mesh;
  const Eigen::Vector3f z = Eigen::Vector3f::UnitZ();
  // (-x,-y): a leaning bracket with a thruster.
  append(mesh, upright_prism(
                   {{0.670F, 0.529F}, {0.770F, 0.529F}, {0.885F, 0.730F}, {0.820F, 0.783F}, {0.800F, 0.770F}},
                   kOppositeDiagonal, -0.100F, 0.100F));
  const Eigen::Vector3f back(std::cos(kOppositeDiagonal), std::sin(kOppositeDiagonal), 0.0F);
  const Outline nozzle = {
      {0.050F, 0.0F}, {0.062F, 0.150F}, {0.055F, 0.150F}, {0.040F, 0.100F}, {0.0F, 0.100F}};
  append(mesh, placed(revolve(nozzle, 12), frame_along(0.790F * back + 0.610F * z, back)));
  // (+x,+y): a bracket with two thrusters, one above the other.
  append(mesh, upright_prism({{0.836F, 0.529F}, {0.965F, 0.529F}, {0.965F, 0.715F}, {0.890F, 0.715F}},
                             kDiagonal, -0.075F, 0.075F));
  const Eigen::Vector3f out(std::cos(kDiagonal), std::sin(kDiagonal), 0.0F);
  for (const float height : {0.578F, 0.665F}) {
    append(mesh, tube(0.960F * out + height * z, 1.040F * out + height * z, 0.035F, 0.025F, 12));
  }
  // (+x,-y) and (-x,+y): low-gain antennas on their boxes.
  append(mesh, tube({0.635F, -0.632F, 0.613F}, {0.635F, -0.632F, 0.710F}, 0.026F, 0.013F, 10));
  append(mesh, tube({-0.635F, 0.632F, 0.613F}, {-0.635F, 0.632F, 0.710F}, 0.026F, 0.013F, 10));
  return mesh;
}

}  // namespace

TriangleMesh make_near_shoemaker() {
  TriangleMesh mesh;
  mesh.name = "near_shoemaker";
  for (const TriangleMesh& part : {body(), decks(), gussets(), panels(), antenna(), adapter_ring(),
                                   main_thruster(), deck_boxes(), aft_instruments(), forward_corners()}) {
    append(mesh, part);
  }
  return mesh;
}

}  // namespace tumblesight::sim

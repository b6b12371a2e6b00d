#include <iterator>
#include <vector>

#include "sim/world/math/angles.hpp"
#include "sim/world/target/primitives.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {

namespace {

constexpr int kX = 0;
constexpr int kY = 1;

// The part at all four combinations of the signs of x and y.
TriangleMesh in_four_corners(const TriangleMesh& part) {
  return with_mirror_image(with_mirror_image(part, kX), kY);
}

TriangleMesh high_gain_antenna() {
  // From the skirt up the back, over the rim and down the front; then the feed in the dish's centre.
  const Outline dish = {{0.456F, 1.142F}, {0.893F, 1.142F}, {0.892F, 1.383F}, {1.023F, 1.431F},
                        {1.158F, 1.493F}, {1.296F, 1.564F}, {1.436F, 1.644F}, {1.575F, 1.729F},
                        {1.713F, 1.817F}, {1.848F, 1.906F}, {1.839F, 1.919F}, {1.647F, 1.792F},
                        {1.433F, 1.660F}, {1.194F, 1.533F}, {1.026F, 1.457F}, {0.646F, 1.325F},
                        {0.334F, 1.263F}, {0.0F, 1.239F}};
  const Outline feed = {{0.091F, 1.243F}, {0.062F, 1.532F}, {0.047F, 1.533F},
                        {0.063F, 1.730F}, {0.019F, 1.730F}, {0.012F, 1.643F}};
  TriangleMesh mesh = revolve(dish, 48);
  append(mesh, revolve(feed, 12));
  append(mesh, prism({{-0.460F, 0.765F},
                      {-0.460F, -0.765F},
                      {-0.430F, -0.782F},
                      {0.892F, -0.019F},
                      {0.892F, 0.019F},
                      {-0.430F, 0.782F}},
                     1.085F, 1.140F));
  return mesh;
}

// The subreflector on three pairs of legs; at each pair's end a tab.
TriangleMesh subreflector() {
  const Outline mirror = {{0.0F, 2.367F},   {0.052F, 2.376F}, {0.101F, 2.394F}, {0.146F, 2.413F},
                          {0.186F, 2.431F}, {0.224F, 2.451F}, {0.257F, 2.468F}, {0.287F, 2.484F},
                          {0.287F, 2.510F}, {0.0F, 2.510F}};
  const Outline antenna = {{0.091F, 2.510F}, {0.062F, 2.706F}, {0.037F, 2.706F},
                           {0.037F, 2.783F}, {0.084F, 2.783F}, {0.084F, 2.796F},
                           {0.037F, 2.796F}, {0.037F, 2.817F}, {0.0F, 2.817F}};
  TriangleMesh mesh = revolve(mirror, 24);
  append(mesh, revolve(antenna, 12));
  TriangleMesh pair =
      with_mirror_image(tube({0.888F, 0.025F, 1.394F}, {0.169F, 0.250F, 2.494F}, 0.013F, 0.013F, 6), kY);
  for (const float heading : {0.0F, 2.0F * kPi_f / 3.0F, 4.0F * kPi_f / 3.0F}) {
    append(mesh, placed(pair, turned(heading)));
    append(mesh, placed(box_between({-0.320F, -0.042F, 2.484F}, {-0.270F, 0.042F, 2.510F}), turned(heading)));
  }
  return mesh;
}

TriangleMesh forward_box() {
  TriangleMesh mesh = box_between({-0.488F, -0.651F, -0.589F}, {0.488F, 0.651F, 1.141F});
  // Louvres: three rows of two on -x; on +x four plates of different sizes and one across.
  for (const float row : {-0.156F, 0.318F, 0.784F}) {
    append(mesh, with_mirror_image(
                     box_between({-0.524F, 0.098F, row - 0.207F}, {-0.451F, 0.515F, row + 0.207F}), kY));
  }
  append(mesh, with_mirror_image(box_between({0.451F, 0.019F, 0.023F}, {0.499F, 0.515F, 0.474F}), kY));
  append(mesh, box_between({0.451F, -0.515F, -0.429F}, {0.499F, 0.515F, -0.015F}));
  append(mesh, box_between({0.446F, -0.517F, 0.519F}, {0.503F, -0.030F, 1.009F}));
  append(mesh, box_between({0.451F, 0.078F, 0.577F}, {0.524F, 0.515F, 0.991F}));
  // The star scanner's baffle on -y.
  const Outline scanner = {{0.084F, 0.618F}, {0.074F, 0.664F}, {0.135F, 0.863F},
                           {0.119F, 0.863F}, {0.074F, 0.664F}, {0.0F, 0.664F}};
  append(mesh,
         placed(revolve(scanner, 16), frame_along({-0.005F, 0.0F, -0.300F}, -Eigen::Vector3f::UnitY())));
  return mesh;
}

// Ten flats with chamfered corners between them.
TriangleMesh bus() {
  struct Level {
    float z, apothem, half_flat;
  };
  constexpr Level kLevels[] = {{-1.117F, 0.887F, 0.280F}, {-1.093F, 0.887F, 0.263F},
                               {-1.076F, 0.907F, 0.247F}, {-1.062F, 0.907F, 0.231F},
                               {-0.640F, 0.907F, 0.231F}, {-0.626F, 0.907F, 0.247F},
                               {-0.609F, 0.887F, 0.263F}, {-0.585F, 0.887F, 0.280F}};
  constexpr int kSides = 10;
  std::vector<Loop> loops;
  for (const Level& level : kLevels) {
    Loop& loop = loops.emplace_back();
    for (int side = 0; side < kSides; ++side) {
      const Eigen::Isometry3f pose = turned(2.0F * kPi_f * static_cast<float>(side) / kSides);
      loop.push_back(pose * Eigen::Vector3f(level.apothem, -level.half_flat, level.z));
      loop.push_back(pose * Eigen::Vector3f(level.apothem, level.half_flat, level.z));
    }
  }
  TriangleMesh mesh = cap(loops.front());
  for (std::size_t i = 1; i < loops.size(); ++i) {
    append(mesh, band(loops[i - 1], loops[i]));
  }
  append(mesh, cap(loops.back()));
  return mesh;
}

// The ring between bus and motor casing, with four lugs on +-x and +-y, and the cavity beneath.
TriangleMesh motor_adapter() {
  constexpr int kSides = 24;
  const auto ring_with_lugs = [](float radius, float lug, float z) {
    Loop loop = loop_at(regular_polygon(kSides, radius, 0.0F), z);
    for (int i = 0; i < kSides; ++i) {
      const int from_lug = (i + 1) % (kSides / 4);  // a lug reaches one corner to either side of its axis
      if (from_lug <= 2) {
        loop[i].head<2>() *= (radius + lug) / radius;
      }
    }
    return loop;
  };
  const Loop levels[] = {ring_with_lugs(0.578F, 0.0F, -1.109F), ring_with_lugs(0.695F, 0.0F, -1.278F),
                         ring_with_lugs(0.784F, 0.036F, -1.473F), ring_with_lugs(0.812F, 0.039F, -1.696F),
                         ring_with_lugs(0.785F, 0.0F, -1.709F)};
  TriangleMesh mesh = revolve(
      {{0.785F, -1.709F}, {0.687F, -1.621F}, {0.628F, -1.621F}, {0.628F, -1.559F}, {0.0F, -1.559F}}, kSides);
  for (std::size_t i = 1; i < std::size(levels); ++i) {
    append(mesh, band(levels[i - 1], levels[i]));
  }
  return mesh;
}

// The panel on +x with its drive and boom; the one on -x is the mirror image, so that both lie in one plane.
TriangleMesh wings() {
  // Frame of the panel: x along the boom, y up the panel, z along the normal of its cells.
  const Eigen::Isometry3f panel =
      frame_at({3.3105F, 0.032F, -0.517F}, Eigen::Vector3f::UnitX(), {0.0F, 1.0F, 1.0F});
  TriangleMesh one = as_panel(placed(box({2.277F, 2.711F, 0.022F}), panel));
  append(one, placed(box({2.168F, 0.109F, 0.054F}),
                     frame_at({3.311F, 0.0105F, -0.4965F}, Eigen::Vector3f::UnitX(), {0.0F, 1.0F, 1.0F})));
  const Outline drive = {{0.062F, 0.461F}, {0.062F, 0.644F}, {0.072F, 1.040F}, {0.091F, 1.345F},
                         {0.098F, 1.403F}, {0.109F, 1.477F}, {0.109F, 1.640F}, {0.083F, 1.640F},
                         {0.055F, 1.749F}, {0.031F, 1.753F}, {0.031F, 2.263F}, {0.0F, 2.263F}};
  append(one, placed(revolve(drive, 12), frame_along({0.0F, -0.001F, -0.4855F}, Eigen::Vector3f::UnitX())));
  return with_mirror_image(one, kX);
}

// The altimeter's horn on -x. Frame: x towards the mouth, y along +y, z towards the bus side.
TriangleMesh altimeter() {
  const Eigen::Isometry3f horn =
      frame_at({-1.767F, 0.0F, 1.092F}, {-0.379F, 0.0F, 0.925F}, Eigen::Vector3f::UnitY());
  const auto rectangle = [](float along, float half_width, float from, float to) {
    return Loop{{along, -half_width, from},
                {along, half_width, from},
                {along, half_width, to},
                {along, -half_width, to}};
  };
  const Loop throat_outside = rectangle(-0.735F, 0.052F, -0.080F, -0.003F);
  const Loop mouth_outside = rectangle(0.804F, 0.3135F, -0.183F, 0.115F);
  const Loop mouth_inside = rectangle(0.804F, 0.292F, -0.170F, 0.101F);
  const Loop throat_inside = rectangle(-0.722F, 0.048F, -0.048F, -0.007F);
  TriangleMesh mesh = band(throat_outside, mouth_outside);
  append(mesh, band(mouth_outside, mouth_inside));
  append(mesh, band(mouth_inside, throat_inside));
  append(mesh, cap(throat_inside));
  append(mesh, prism({{-0.797F, -0.052F},
                      {-0.735F, -0.052F},
                      {-0.735F, 0.053F},
                      {-0.838F, 0.053F},
                      {-0.884F, -0.021F},
                      {-0.884F, -0.052F}},
                     -0.081F, -0.004F));
  append(mesh, prism({{-0.884F, -0.155F}, {-0.796F, -0.155F}, {-0.796F, -0.052F}, {-0.884F, -0.052F}},
                     -0.081F, -0.004F));
  mesh = placed(mesh, horn);
  append(mesh, tube({-1.413F, 0.004F, 0.489F}, {-0.506F, 0.004F, -0.486F}, 0.019F, 0.019F, 6));
  append(mesh, tube({-1.825F, 0.245F, 1.656F}, {-0.852F, -0.243F, 1.164F}, 0.019F, 0.019F, 6));
  append(mesh, with_mirror_image(
                   tube({-1.826F, 0.245F, 1.656F}, {-0.846F, 0.245F, 1.161F}, 0.019F, 0.019F, 6), kY));
  append(mesh, with_mirror_image(
                   tube({-0.840F, 0.255F, 1.189F}, {-1.440F, 0.008F, 0.472F}, 0.019F, 0.019F, 6), kY));
  return mesh;
}

// The medium-gain antenna: an open cone on +y, on its seat at the foot of the forward box.
TriangleMesh medium_gain_antenna() {
  const Outline cone = {{0.0F, 0.0F},     {0.034F, 0.0F},   {0.228F, 0.969F},
                        {0.194F, 0.969F}, {0.028F, 0.054F}, {0.0F, 0.054F}};
  TriangleMesh mesh =
      placed(revolve(cone, 24), frame_along({0.0F, 0.848F, -0.5525F}, {0.0F, 0.882F, 0.471F}));
  append(mesh, upright_prism({{0.727F, -0.584F}, {0.876F, -0.584F}, {0.876F, -0.473F}, {0.798F, -0.482F}},
                             kPi_f / 2.0F, -0.064F, 0.064F));
  return mesh;
}

// One thruster pod at the end of its struts, in the frame (u, v, z): u horizontal, away from the z axis along
// the diagonal between +x and +y, v horizontal, to its left.
TriangleMesh thruster_pod() {
  // Cross-sections along u: the lower and the upper edge.
  struct Section {
    float u_low, z_low, u_high, z_high, v_from, v_to;
  };
  constexpr Section kSections[] = {{1.744F, -1.385F, 1.724F, -1.236F, -0.161F, 0.178F},
                                   {1.774F, -1.388F, 1.751F, -1.226F, -0.180F, 0.192F},
                                   {1.860F, -1.362F, 1.839F, -1.232F, -0.166F, 0.180F},
                                   {1.945F, -1.325F, 1.928F, -1.237F, -0.122F, 0.138F},
                                   {2.183F, -1.291F, 2.165F, -1.196F, -0.104F, 0.122F}};
  std::vector<Loop> loops;
  for (const Section& s : kSections) {
    loops.push_back({{s.u_low, s.v_from, s.z_low},
                     {s.u_low, s.v_to, s.z_low},
                     {s.u_high, s.v_to, s.z_high},
                     {s.u_high, s.v_from, s.z_high}});
  }
  TriangleMesh mesh = cap(loops.front());
  for (std::size_t i = 1; i < loops.size(); ++i) {
    append(mesh, band(loops[i - 1], loops[i]));
  }
  append(mesh, cap(loops.back()));
  append(mesh, upright_prism({{1.945F, -1.573F}, {2.054F, -1.573F}, {2.054F, -1.303F}, {1.945F, -1.321F}},
                             0.0F, -0.073F, 0.090F));
  // A flat thruster below, on its side, that narrows outwards.
  append(mesh, loft({{1.797F, -0.111F, -1.578F},
                     {1.797F, 0.117F, -1.578F},
                     {1.797F, 0.117F, -1.548F},
                     {1.797F, -0.111F, -1.548F}},
                    {{1.969F, -0.045F, -1.568F},
                     {1.969F, 0.062F, -1.568F},
                     {1.966F, 0.062F, -1.525F},
                     {1.966F, -0.045F, -1.525F}}));
  const Outline thruster = {{0.031F, -1.285F}, {0.031F, -1.395F}, {0.012F, -1.421F}, {0.042F, -1.490F},
                            {0.055F, -1.530F}, {0.055F, -1.562F}, {0.040F, -1.490F}, {0.0F, -1.423F}};
  for (const float v : {-0.050F, 0.0714F}) {
    append(mesh, placed(revolve(thruster, 8), Eigen::Isometry3f(Eigen::Translation3f(2.146F, v, 0.0F))));
  }
  return mesh;
}

TriangleMesh pods_and_struts() {
  TriangleMesh one = placed(thruster_pod(), turned(kPi_f / 4.0F));
  append(one, tube({0.203F, 0.321F, -1.141F}, {1.169F, 1.365F, -1.283F}, 0.050F, 0.040F, 6));
  const Eigen::Vector3f rods[][2] = {{{0.810F, 0.048F, -1.663F}, {1.443F, 1.429F, -1.545F}},
                                     {{0.114F, 0.798F, -1.660F}, {1.418F, 1.456F, -1.545F}},
                                     {{0.239F, 0.365F, -1.142F}, {1.342F, 1.206F, -1.274F}},
                                     {{0.824F, 0.056F, -1.646F}, {1.382F, 1.169F, -1.315F}},
                                     {{0.136F, 0.813F, -1.646F}, {1.138F, 1.381F, -1.321F}},
                                     {{0.865F, 0.279F, -1.101F}, {1.461F, -0.003F, -0.505F}}};
  for (const auto& rod : rods) {
    append(one, tube(rod[0], rod[1], 0.015F, 0.015F, 6));
  }
  return in_four_corners(one);
}

}  // namespace

TriangleMesh make_magellan() {
  TriangleMesh mesh;
  mesh.name = "magellan";
  for (const TriangleMesh& part : {high_gain_antenna(), subreflector(), forward_box(), bus(), motor_adapter(),
                                   wings(), altimeter(), medium_gain_antenna(), pods_and_struts()}) {
    append(mesh, part);
  }
  return mesh;
}

}  // namespace tumblesight::sim

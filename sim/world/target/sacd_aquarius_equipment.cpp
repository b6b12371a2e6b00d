#include <cmath>

#include "sim/world/target/primitives.hpp"
#include "sim/world/target/shipped_meshes.hpp"

namespace tumblesight::sim {

namespace {

constexpr int kY = 1;

// A cylinder along x between two positions.
TriangleMesh rod_along_x(float x_from, float x_to, float y, float z, float radius) {
  return tube({x_from, y, z}, {x_to, y, z}, radius, radius, 12);
}

// On +x: two antennas with curved fronts that lean on each other, and the frame between them.
TriangleMesh curved_antennas() {
  // Profiles across the antenna: (height of the arc, z).
  const Outline body = {{0.0F, 0.333F},    {0.0127F, 0.333F}, {0.0335F, 0.363F}, {0.050F, 0.400F},
                        {0.0635F, 0.442F}, {0.071F, 0.488F},  {0.0735F, 0.536F}, {0.071F, 0.584F},
                        {0.0635F, 0.629F}, {0.050F, 0.672F},  {0.0335F, 0.709F}, {0.0127F, 0.739F},
                        {0.0F, 0.739F}};
  const Outline cover = {{0.052F, 0.363F}, {0.070F, 0.400F}, {0.084F, 0.442F},
                         {0.092F, 0.488F}, {0.094F, 0.536F}, {0.092F, 0.584F},
                         {0.084F, 0.629F}, {0.070F, 0.672F}, {0.052F, 0.708F}};
  // Frame: x out of the front, y up, z along the antenna towards the bus.
  const Eigen::Isometry3f pose =
      frame_at({0.319F, -0.522F, 0.0F}, {0.531F, -0.847F, 0.0F}, Eigen::Vector3f::UnitZ());
  TriangleMesh one = placed(prism(body, -0.926F, 0.0F), pose);
  append(one, placed(prism(cover, -0.955F, 0.017F), pose));
  for (const float height : {0.372F, 0.6985F}) {
    append(one, tube({0.590F, -0.194F, height}, {1.030F, -0.012F, height}, 0.013F, 0.013F, 4));
  }
  TriangleMesh mesh = with_mirror_image(one, kY);
  for (const float height : {0.372F, 0.6985F}) {
    append(mesh, tube({0.596F, 0.0F, height}, {1.030F, 0.0F, height}, 0.013F, 0.013F, 4));
  }
  append(mesh, with_mirror_image(placed(box({0.048F, 0.011F, 0.335F}),
                                        Eigen::Translation3f(1.0675F, 0.0265F, 0.536F) * turned(1.02F)),
                                 kY));
  return mesh;
}

// On +x, below the antennas: housings, the larger camera with its hood, baffled sensors.
TriangleMesh housings_on_plus_x() {
  TriangleMesh mesh = box_between({0.579F, -0.182F, -0.208F}, {0.861F, 0.182F, 0.222F});
  append(mesh, box_between({0.858F, -0.190F, -0.218F}, {0.868F, 0.190F, 0.232F}));
  append(mesh, box_between({0.868F, -0.024F, -0.220F}, {0.898F, 0.169F, -0.054F}));
  append(mesh, box_between({0.578F, -0.194F, -0.990F}, {0.706F, 0.194F, -0.542F}));
  // The camera: a wedge along x, a hood on its -y side, a bracket on +y.
  const auto along_x = [](const Outline& profile_yz, float x_from, float x_to) {
    Loop from;
    Loop to;
    for (const Eigen::Vector2f& p : profile_yz) {
      from.emplace_back(x_from, p.x(), p.y());
      to.emplace_back(x_to, p.x(), p.y());
    }
    return loft(from, to);
  };
  append(
      mesh,
      along_x(
          {{-0.148F, -0.284F}, {-0.065F, -0.223F}, {0.200F, -0.223F}, {0.192F, -0.349F}, {0.030F, -0.516F}},
          0.479F, 0.927F));
  append(mesh, along_x({{0.192F, -0.223F}, {0.312F, -0.223F}, {0.280F, -0.349F}, {0.192F, -0.349F}}, 0.479F,
                       0.868F));
  append(mesh, loft({{0.477F, -0.148F, -0.284F},
                     {0.928F, -0.148F, -0.284F},
                     {0.928F, 0.025F, -0.515F},
                     {0.477F, 0.025F, -0.515F}},
                    {{0.588F, -0.311F, -0.399F},
                     {0.817F, -0.311F, -0.399F},
                     {0.817F, -0.109F, -0.657F},
                     {0.588F, -0.109F, -0.657F}}));
  // Two sensors in an open, tilted baffle.
  append(mesh, upright_prism({{0.336F, -0.049F},
                              {0.679F, -0.049F},
                              {0.778F, -0.019F},
                              {0.692F, 0.267F},
                              {0.592F, 0.237F},
                              {0.336F, 0.237F}},
                             0.0F, -0.487F, -0.354F));
  const Loop mouth = {{0.914F, -0.479F, 0.011F},
                      {0.914F, -0.342F, 0.011F},
                      {0.823F, -0.342F, 0.320F},
                      {0.823F, -0.479F, 0.320F}};
  const Loop floor = {{0.784F, -0.479F, -0.025F},
                      {0.784F, -0.342F, -0.025F},
                      {0.694F, -0.342F, 0.277F},
                      {0.694F, -0.479F, 0.277F}};
  append(mesh, band(mouth, floor));
  append(mesh, cap(floor));
  for (const Eigen::Vector3f& sensor :
       {Eigen::Vector3f(0.716F, -0.411F, 0.176F), Eigen::Vector3f(0.745F, -0.411F, 0.080F)}) {
    append(mesh, tube(sensor, sensor + Eigen::Vector3f(0.085F, 0.0F, 0.026F), 0.052F, 0.052F, 8));
  }
  return mesh;
}

// A shallow bowl with an elliptic rim: half axes along x and y of its frame, the rim `depth` below its
// middle.
TriangleMesh bowl(float half_x, float half_y, float depth, const Eigen::Isometry3f& pose) {
  Outline rim = regular_polygon(16, 1.0F, 0.0F);
  Loop edge;
  Loop half_way;
  for (const Eigen::Vector2f& p : rim) {
    edge.emplace_back(half_x * p.x(), half_y * p.y(), -depth);
    half_way.emplace_back(half_x * p.x() / 2.0F, half_y * p.y() / 2.0F, -0.25F * depth);
  }
  TriangleMesh mesh = band(edge, half_way);
  append(mesh, cap(half_way));
  return placed(mesh, pose);
}

// On +x, at the bus's lower corners: two small tilted antennas on their brackets.
TriangleMesh small_antennas() {
  TriangleMesh mesh =
      bowl(0.200F, 0.252F, 0.038F,
           frame_at({0.710F, 0.505F, -0.778F}, {0.782F, 0.595F, 0.186F}, {0.533F, -0.483F, -0.695F}));
  append(mesh,
         placed(box({0.300F, 0.120F, 0.030F}),
                frame_at({0.610F, 0.435F, -0.835F}, {0.809F, 0.528F, 0.260F}, {-0.535F, 0.475F, 0.699F})));
  append(mesh,
         bowl(0.200F, 0.121F, 0.028F,
              frame_at({0.623F, -0.440F, -0.637F}, {-0.179F, -0.490F, 0.853F}, {-0.948F, 0.318F, -0.016F})));
  append(mesh,
         placed(box({0.200F, 0.070F, 0.030F}),
                frame_at({0.530F, -0.400F, -0.640F}, {0.932F, -0.361F, -0.014F}, {0.178F, 0.493F, -0.852F})));
  return mesh;
}

// Round rods on +-x, each with the equipment at its end.
TriangleMesh stand_offs() {
  TriangleMesh mesh;
  // +x: a pair of thrusters on a plate, and two single ones.
  append(mesh, rod_along_x(0.580F, 0.919F, -0.325F, -0.194F, 0.044F));
  append(mesh, box_between({0.917F, -0.376F, -0.318F}, {0.928F, -0.274F, -0.069F}));
  for (const float height : {-0.269F, -0.118F}) {
    append(mesh, rod_along_x(0.921F, 0.960F, -0.325F, height, 0.027F));
    append(mesh, rod_along_x(0.957F, 1.132F, -0.325F, height, 0.043F));
  }
  for (const float height : {-0.391F, 0.015F}) {
    append(mesh, rod_along_x(0.500F, 0.918F, 0.316F, height, 0.038F));
    append(mesh, rod_along_x(0.918F, 0.950F, 0.316F, height, 0.028F));
    append(mesh, rod_along_x(0.946F, 1.084F, 0.316F, height, 0.043F));
  }
  // -x: the same pair, two round patches, and a pair of rings on a tilted plate.
  append(mesh, rod_along_x(-0.590F, -1.021F, -0.158F, -0.351F, 0.044F));
  append(mesh, box_between({-1.030F, -0.209F, -0.476F}, {-1.019F, -0.107F, -0.227F}));
  for (const float height : {-0.426F, -0.276F}) {
    append(mesh, rod_along_x(-1.021F, -1.062F, -0.158F, height, 0.027F));
    append(mesh, rod_along_x(-1.059F, -1.234F, -0.158F, height, 0.043F));
  }
  append(mesh, rod_along_x(-0.590F, -1.034F, 0.141F, -0.610F, 0.040F));
  append(mesh, tube({-1.025F, 0.141F, -0.610F}, {-1.075F, 0.141F, -0.610F}, 0.130F, 0.130F, 24));
  append(mesh, rod_along_x(-0.585F, -1.034F, -0.167F, -0.895F, 0.040F));
  append(mesh, tube({-1.022F, -0.168F, -0.891F}, {-1.071F, -0.166F, -0.900F}, 0.130F, 0.130F, 24));
  append(mesh, rod_along_x(-0.585F, -1.102F, 0.116F, -0.972F, 0.040F));
  append(mesh,
         placed(box({0.253F, 0.104F, 0.013F}),
                frame_at({-1.102F, 0.116F, -0.970F}, Eigen::Vector3f::UnitY(), {-0.146F, 0.0F, 0.989F})));
  for (const float side : {0.039F, 0.193F}) {
    append(mesh, tube({-1.104F, side, -0.968F}, {-1.138F, side, -0.973F}, 0.051F, 0.051F, 12));
  }
  return mesh;
}

// On -x: a pair of star trackers on a wedge, housings on the corners, a sensor block.
TriangleMesh housings_on_minus_x() {
  TriangleMesh mesh =
      prism({{-0.590F, -0.172F}, {-0.590F, 0.172F}, {-0.695F, 0.003F}, {-0.695F, -0.004F}}, -0.228F, -0.024F);
  const float heading = std::atan2(0.497F, 0.868F);
  TriangleMesh tracker = placed(box({0.144F, 0.138F, 0.138F}),
                                Eigen::Translation3f(-0.706F, -0.124F, -0.126F) * turned(heading));
  append(tracker, tube({-0.766F, -0.158F, -0.126F}, {-0.869F, -0.214F, -0.126F}, 0.043F, 0.066F, 16));
  append(mesh, with_mirror_image(tracker, kY));
  append(mesh, prism({{-0.670F, 0.221F},
                      {-0.594F, 0.179F},
                      {-0.492F, 0.158F},
                      {-0.458F, 0.323F},
                      {-0.559F, 0.342F},
                      {-0.652F, 0.307F}},
                     0.264F, 0.466F));
  append(mesh, prism({{-0.534F, -0.301F}, {-0.588F, -0.247F}, {-0.675F, -0.351F}, {-0.641F, -0.386F}}, 0.261F,
                     0.662F));
  append(mesh, prism({{-0.575F, -0.277F}, {-0.420F, -0.432F}, {-0.579F, -0.587F}, {-0.613F, -0.552F}},
                     -0.630F, -0.480F));
  append(mesh,
         placed(box({0.274F, 0.121F, 0.004F}),
                frame_at({-0.686F, -0.406F, -0.556F}, {0.134F, 0.991F, 0.0F}, Eigen::Vector3f::UnitZ())));
  for (const float side : {-0.465F, -0.413F, -0.362F}) {
    append(mesh, tube({-0.590F, side, -0.541F}, {-0.670F, side, -0.541F}, 0.019F, 0.019F, 6));
  }
  return mesh;
}

// On +-y, behind the panels: the panels' stand-offs, and on -y a rail and the two sensors behind the windows.
TriangleMesh behind_the_panels() {
  TriangleMesh post = tube({0.295F, 0.511F, 0.167F}, {0.295F, 0.694F, 0.167F}, 0.036F, 0.036F, 8);
  append(post, tube({0.295F, 0.529F, -0.431F}, {0.295F, 0.690F, -0.431F}, 0.013F, 0.013F, 6));
  TriangleMesh mesh = with_mirror_image(with_mirror_image(post, 0), kY);
  append(mesh, loft({{-0.048F, -0.590F, -0.384F},
                     {0.048F, -0.590F, -0.384F},
                     {0.048F, -0.590F, 0.582F},
                     {-0.048F, -0.590F, 0.582F}},
                    {{-0.028F, -0.650F, -0.360F},
                     {0.028F, -0.650F, -0.360F},
                     {0.028F, -0.650F, 0.559F},
                     {-0.028F, -0.650F, 0.559F}}));
  append(mesh, with_mirror_image(loft({{0.136F, -0.590F, -0.115F},
                                       {0.242F, -0.590F, -0.115F},
                                       {0.242F, -0.590F, 0.025F},
                                       {0.136F, -0.590F, 0.025F}},
                                      {{0.155F, -0.748F, -0.081F},
                                       {0.215F, -0.748F, -0.081F},
                                       {0.215F, -0.722F, 0.018F},
                                       {0.155F, -0.722F, 0.018F}}),
                                 0));
  return mesh;
}

}  // namespace

TriangleMesh make_sacd_aquarius_equipment() {
  TriangleMesh mesh;
  for (const TriangleMesh& part : {curved_antennas(), housings_on_plus_x(), small_antennas(), stand_offs(),
                                   housings_on_minus_x(), behind_the_panels()}) {
    append(mesh, part);
  }
  return mesh;
}

}  // namespace tumblesight::sim

#include "sim/inspection/mesh_inspection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/inspection/cleaned_mesh.hpp"
#include "sim/inspection/findings.hpp"
#include "sim/world/target/shipped_meshes.hpp"
#include "tests/unit/sim/inspection/faulty_meshes.hpp"

namespace tumblesight::sim {
namespace {

TriangleMesh flipped(TriangleMesh mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  return mesh;
}

TriangleMesh half_open(TriangleMesh mesh) {
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 4);  // two sides of the body
  return mesh;
}

TriangleMesh drum() {
  TriangleMesh mesh = frustum(64, 1.0F, 1.0F, -1.5F, 1.5F);
  mesh.name = "drum.obj";
  return mesh;
}

TriangleMesh ball_of(float radius) {
  Outline profile;
  for (int i = 0; i <= 32; ++i) {
    const float angle = 3.14159265F * static_cast<float>(i) / 32.0F;
    profile.push_back({i == 0 || i == 32 ? 0.0F : radius * std::sin(angle), -radius * std::cos(angle)});
  }
  return revolve(profile, 64);
}

// A body with four equal wings, turned as a whole.
TriangleMesh cross(const Eigen::Isometry3f& pose) {
  TriangleMesh mesh = box({1.0F, 1.0F, 1.4F});
  append(mesh, frustum(24, 0.2F, 0.6F, 0.7F, 1.0F));
  for (const Eigen::Vector2f& at : {Eigen::Vector2f(1.5F, 0.0F), {-1.5F, 0.0F}, {0.0F, 1.5F}, {0.0F, -1.5F}})
    append(mesh,
           box_at(at.x(), at.y(), 0.3F,
                  {std::abs(at.x()) > 1.0F ? 2.0F : 0.8F, std::abs(at.y()) > 1.0F ? 2.0F : 0.8F, 0.04F}));
  append(mesh, box_at(0.3F, 0.2F, -0.8F, {0.4F, 0.3F, 0.4F}));  // the only difference
  return placed(mesh, pose);
}

struct Case {
  const char* name;
  TriangleMesh mesh;
  const char* key;  // of the finding that must be there; nullptr: neither fault nor warning
  Severity severity;
  std::vector<const char*> words;
  MeshFileOptions options{};
};

std::vector<Case> cases() {
  const TriangleMesh sound = sound_mesh();
  const Eigen::Isometry3f upright = Eigen::Isometry3f::Identity();
  const Eigen::Isometry3f lying(Eigen::AngleAxisf(-1.5707963F, Eigen::Vector3f::UnitX()));
  const TriangleMesh bit = box_at(6.0F, 0.0F, 0.0F, {0.05F, 0.05F, 0.05F});
  TriangleMesh gltf = sound;
  gltf.name = "sound.glb";
  TriangleMesh with_left_out = sound;
  with_left_out.left_out = 3;
  return {
      {"sound", sound, nullptr, Severity::kNote, {}},
      {"without area", with_left_out, "left_out", Severity::kNote, {"3 triangles"}},
      {"in millimetres", times(sound, 1000.0F), "size", Severity::kFault, {"0.1 to 20 m", "--mesh-scale"}},
      {"in millimetres: the unit",
       times(sound, 1000.0F),
       "unit",
       Severity::kWarning,
       {"in millimetres (--mesh-scale 0.001) it is"}},
      {"in inches",
       times(sound, 39.37F),
       "unit",
       Severity::kWarning,
       {"in inches (--mesh-scale 0.0254) it is"}},
      {"larger than the sensor sees", times(sound, 12.0F), "size", Severity::kFault, {"40 m across"}},
      {"smaller than a hand", times(sound, 0.02F), "size", Severity::kFault, {"0.1 to 20 m"}},
      {"glTF with z up", gltf, "up", Severity::kWarning, {"y by its standard"}, {MeshUp::kZ, 1.0}},
      {"lying", cross(lying), "up", Severity::kWarning, {"--mesh-up z"}},
      {"off its origin",
       moved(sound, {2.0F, 0.0F, 0.0F}),
       "origin",
       Severity::kWarning,
       {"2.0", "centre of mass", "--origin"}},
      {"a stray bit",
       with(sound, bit),
       "strays",
       Severity::kWarning,
       {"1 part of 12 triangles", "to 6.03 m", "of the width"}},
      {"a part that is apart",
       with(sound, box_at(1.2F, -1.2F, -1.0F, {0.1F, 0.1F, 0.1F})),
       "apart",
       Severity::kNote,
       {"1 part"}},
      {"a root cube",
       with(sound, box({1.0F, 1.0F, 1.0F})),
       "marker",
       Severity::kNote,
       {"side of 1 m", "--fix"}},
      {"a root cube around the body",
       with(sound, box({2.0F, 2.0F, 2.0F})),
       "marker",
       Severity::kWarning,
       {"2 m wide", "% of the surface of all other parts", "in place of the spacecraft", "--fix"}},
      {"a CubeSat whose body is a cube",
       cubesat(),
       "marker",
       Severity::kNote,
       {"side of 1 m", "may be the body", "--fix keeps it"}},
      {"a CubeSat with equipment inside",
       with(cubesat(), box({0.5F, 0.5F, 0.6F})),
       "marker",
       Severity::kWarning,
       {"may be the body", "--fix keeps it"}},
      {"a box around everything",
       with(sound, box_at(0.2F, 0.0F, 0.1F, {4.6F, 3.0F, 3.0F})),
       "hidden",
       Severity::kWarning,
       {"100 % of the surface", "backdrop"}},
      {"a sky dome", with(sound, ball_of(8.0F)), "hidden", Severity::kWarning, {"16 m wide", "100 %"}},
      {"a ground plane",
       with(sound, box_between({-4.0F, -4.0F, -1.0F}, {4.0F, 4.0F, -0.999F})),
       "hidden",
       Severity::kWarning,
       {"8 m wide", "ground"}},
      {"doubled", doubled(sound), "repeated", Severity::kNote, {"both sides"}},
      {"flipped", flipped(sound), "turned", Severity::kNote, {"both sides"}},
      {"half open", half_open(sound), "open", Severity::kNote, {"not closed"}},
      {"a box only", box({1.0F, 2.0F, 3.0F}), "triangles", Severity::kWarning, {"12 triangles"}},
      {"the same after half a turn",
       box({1.0F, 2.0F, 3.0F}),
       "symmetry",
       Severity::kFault,
       {"1/2", "cannot be told apart"}},
      {"nearly four-fold",
       cross(upright),
       "symmetry",
       Severity::kWarning,
       {"1/4 of a turn about z", "mm on average"}},
      {"a drum", drum(), "revolution", Severity::kFault, {"about z"}},
      {"a ball", ball_of(2.0F), "sphere", Severity::kFault, {"no network"}},
      {"a whip antenna",
       with(sound, tube({0.0F, 0.0F, 0.5F}, {0.0F, 0.0F, 9.0F}, 0.01F, 0.01F, 8)),
       "reach",
       Severity::kWarning,
       {"95 %", "width of the image"}},
  };
}

// Verifies TS-SIL-360.
TEST(MeshInspection, FindsWhatIsWrongAndSaysWhatToDo) {
  for (const Case& c : cases()) {
    const MeshInspection found = inspect(c.mesh, c.options);
    std::string all;
    for (const Finding& finding : found.findings)
      all += "\n  " + finding.key + ": " + finding.text + " " + finding.remedy;
    if (c.key == nullptr) {
      EXPECT_TRUE(found.findings.empty() || found.findings.front().severity == Severity::kNote)
          << c.name << all;
      continue;
    }
    const auto finding = std::find_if(found.findings.begin(), found.findings.end(),
                                      [&](const Finding& f) { return f.key == c.key; });
    ASSERT_NE(finding, found.findings.end()) << c.name << all;
    EXPECT_EQ(finding->severity, c.severity) << c.name << all;
    for (const char* word : c.words)
      EXPECT_NE((finding->text + " " + finding->remedy).find(word), std::string::npos)
          << c.name << ": '" << word << "'" << all;
  }
}

TEST(MeshInspection, TheGravestFindingComesFirst) {
  const MeshInspection found = inspect(times(half_open(sound_mesh()), 1000.0F), {});
  ASSERT_GE(found.findings.size(), 3U);
  EXPECT_EQ(found.findings.front().severity, Severity::kFault);
  EXPECT_EQ(found.findings.back().severity, Severity::kNote);
}

// One wing that is longer than the others tells the quarter turns apart.
TEST(MeshInspection, WhatBreaksASymmetryIsSeen) {
  const TriangleMesh mesh =
      with(cross(Eigen::Isometry3f::Identity()), box_at(2.8F, 0.0F, 0.3F, {0.8F, 0.8F, 0.04F}));
  const MeshInspection found = inspect(mesh, {});
  for (const Finding& finding : found.findings) EXPECT_NE(finding.key, "symmetry") << finding.text;
}

TEST(MeshInspection, StraysDoNotCountForCentreAndSymmetry) {
  const MeshInspection alone = inspect(sound_mesh(), {});
  const MeshInspection found =
      inspect(with(sound_mesh(), box_at(6.0F, 0.0F, 0.0F, {0.05F, 0.05F, 0.05F})), {});
  EXPECT_EQ(found.symmetry.centre_trf_m, alone.symmetry.centre_trf_m);
  EXPECT_EQ(found.core_radius_m, alone.radius_m);
  EXPECT_NEAR(found.radius_m, 6.025, 1e-3);
}

const Finding* finding_of(const MeshInspection& found, const std::string& key) {
  const auto finding = std::find_if(found.findings.begin(), found.findings.end(),
                                    [&](const Finding& f) { return f.key == key; });
  return finding == found.findings.end() ? nullptr : &*finding;
}

// The rays of the views are spread over the mesh, wherever its origin is.
TEST(MeshInspection, AnOriginFarAwayChangesNothingButTheOrigin) {
  const MeshInspection alone = inspect(sound_mesh(), {});
  for (const float scale : {1.0F, 1000.0F}) {
    const Eigen::Vector3f off = scale * Eigen::Vector3f(450.0F, -30.0F, 0.0F);
    const MeshInspection found = inspect(moved(times(sound_mesh(), scale), off), {MeshUp::kY, 1.0});
    EXPECT_NEAR(found.centred_radius_m, scale * alone.centred_radius_m, 0.01 * scale);
    const Eigen::Vector3d centre = scale * alone.symmetry.centre_trf_m + off.cast<double>();
    EXPECT_LT((found.symmetry.centre_trf_m - centre).norm(), 0.01 * scale);
    EXPECT_TRUE(finding_of(found, "size") != nullptr && finding_of(found, "origin") != nullptr);
    EXPECT_EQ(finding_of(found, "unit") != nullptr, scale > 1.0F)
        << "the unit is judged by the surface's own size";
    EXPECT_STREQ(found.likely_units.front().name, scale > 1.0F ? "millimetres" : "metres");
    const CleanedMesh clean = cleaned(moved(times(sound_mesh(), scale), off), found, {});
    EXPECT_LT(inspect(clean.mesh, {}).centre_distance_m(), 0.02 * scale);
  }
}

TEST(MeshInspection, APartFarAwayIsAStray) {
  const TriangleMesh far_part = with(sound_mesh(), box_at(800.0F, 0.0F, 0.0F, {0.1F, 0.1F, 0.1F}));
  const MeshInspection found = inspect(far_part, {});
  EXPECT_EQ(found.strays.size(), 1U);
  EXPECT_NEAR(found.core_radius_m, inspect(sound_mesh(), {}).radius_m, 1e-6);
  // What marks an origin that is far from the craft.
  const MeshInspection marked = inspect(moved(far_part, {-800.0F, 0.0F, 0.0F}), {});
  ASSERT_EQ(marked.strays.size(), 1U);
  EXPECT_NE(finding_of(marked, "strays")->text.find("radii away"), std::string::npos);
}

// Surfaces that give the rays little or nothing to meet.
TEST(MeshInspection, OddSurfacesAreJudgedAndDoNotCrash) {
  const auto triangle = [](const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
    TriangleMesh mesh;
    mesh.name = "odd.stl";
    mesh.vertices_trf_m = {Eigen::Vector3f::Zero(), b, c};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
  };
  const TriangleMesh needle = triangle({1.0F, 0.0F, 0.0F}, {0.0F, 1e-6F, 0.0F});
  for (const TriangleMesh& mesh :
       {triangle({1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}), needle, moved(needle, {300.0F, 0.0F, 0.0F}),
        with(needle, moved(needle, {900.0F, 0.0F, 0.0F})), times(sound_mesh(), 1e8F),
        times(sound_mesh(), 1e-8F),
        with(box({1.0F, 1.0F, 1.0F}), box_at(9e8F, 0.0F, 0.0F, {500.0F, 500.0F, 500.0F}))}) {
    const MeshInspection found = inspect(mesh, {});
    EXPECT_TRUE(found.symmetry.centre_trf_m.allFinite());
    EXPECT_TRUE(std::isfinite(found.centred_radius_m) && found.centred_radius_m > 0.0);
    EXPECT_TRUE(std::isfinite(found.radius_of_95_m));
    for (const SymmetryAxis& axis : found.symmetry.axes) EXPECT_TRUE(std::isfinite(axis.any_turn_m));
    EXPECT_FALSE(found.findings.empty());
    EXPECT_TRUE(cleaned(mesh, found, {}).moved_m.allFinite());
  }
}

TEST(MeshInspection, WhatTheFileHadBesidesIsFound) {
  TriangleMesh mesh = sound_mesh();
  mesh.notes = {"3 lines left out"};
  mesh.losses = {"2 polygons cannot be divided"};
  const MeshInspection found = inspect(mesh, {});
  ASSERT_NE(finding_of(found, "lost"), nullptr);
  EXPECT_EQ(finding_of(found, "lost")->severity, Severity::kWarning);
  ASSERT_NE(finding_of(found, "not_read"), nullptr);
  EXPECT_TRUE(std::is_sorted(found.findings.begin(), found.findings.end(),
                             [](const Finding& a, const Finding& b) { return a.severity < b.severity; }));
}

TEST(LikelyUnits, AreThoseInWhichASpacecraftHasAUsualSize) {
  EXPECT_STREQ(likely_units(2.8).front().name, "metres");
  EXPECT_STREQ(likely_units(2800.0).front().name, "millimetres");
  EXPECT_STREQ(likely_units(110.0).front().name, "inches");
  EXPECT_TRUE(likely_units(1e6).empty());
}

TEST(AxisName, IsShortAlongTheFramesAxes) {
  EXPECT_EQ(axis_name(Eigen::Vector3d::UnitY()), "y");
  EXPECT_EQ(axis_name(-Eigen::Vector3d::UnitZ()), "-z");
  EXPECT_EQ(axis_name(Eigen::Vector3d(0.6, 0.0, 0.8)), "(0.60, 0.00, 0.80)");
}

}  // namespace
}  // namespace tumblesight::sim

#include "sim/report/mesh_report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/unit/sim/inspection/faulty_meshes.hpp"
#include "tests/unit/sim/report/markup_checks.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kPixels = 64;

MeshReport report_of(const TriangleMesh& mesh) {
  MeshReport report;
  report.file = "a<b.stl";
  report.found = inspect(mesh, report.options);
  report.command = "tumblesight mesh a<b.stl";
  return report;
}

// Verifies TS-SIL-360.
TEST(MeshReport, ShowsFactsSidesAndFindingsInText) {
  const TriangleMesh mesh = moved(sound_mesh(), {2.0F, 0.0F, 0.0F});
  const std::string text = mesh_text(report_of(mesh), six_views(mesh, kPixels));
  for (const char* part : {"a<b.stl", "radius", "from -z: -x right, +y up", "  warning  The origin is 2"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in:\n" << text;
}

TEST(MeshReport, IsSelfContainedAndWellFormedAsAPage) {
  const TriangleMesh mesh = moved(sound_mesh(), {2.0F, 0.0F, 0.0F});
  const std::string page = mesh_page(report_of(mesh), six_views(mesh, kPixels));
  EXPECT_EQ(svgs_of(page).size(), 6U);
  for (const std::string& svg : svgs_of(page)) EXPECT_EQ(xml_fault(svg), "");
  EXPECT_EQ(outside_reference(page), "");
  EXPECT_EQ(page.find("a<b"), std::string::npos) << "not escaped";
  EXPECT_NE(page.find("warning: The origin is 2"), std::string::npos);
}

TEST(MeshReport, GivesEveryFigureAsJson) {
  const MeshReport report = report_of(box({1.0F, 2.0F, 3.0F}));
  const nlohmann::json json = mesh_json(report);
  EXPECT_EQ(json.at("triangles"), 12);
  EXPECT_EQ(json.at("axes").at(0).at("turns").at(0).at("fold"), 2);
  EXPECT_NEAR(json.at("axes").at(0).at("turns").at(0).at("moved_m"), 0.0, 2e-3);
  EXPECT_EQ(json.at("findings").size(), report.found.findings.size());
  EXPECT_EQ(json.at("findings").at(0).at("severity"), "fault");
}

}  // namespace
}  // namespace tumblesight::sim

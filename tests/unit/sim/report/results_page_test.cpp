#include "sim/report/results_page.hpp"

#include <gtest/gtest.h>

#include "tests/support/sample_results.hpp"
#include "tests/unit/sim/report/markup_checks.hpp"

namespace tumblesight::sim {
namespace {

TEST(ResultsPage, HoldsWellFormedFigures) {
  const std::vector<std::string> svgs = svgs_of(results_page(sample_results()));
  EXPECT_EQ(svgs.size(), 10U);
  for (const std::string& svg : svgs) {
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  }
}

TEST(ResultsPage, NeedsNothingButItself) {
  EXPECT_EQ(outside_reference(results_page(sample_results())), "");
}

TEST(ResultsPage, ShowsEveryCellAndEscapesNames) {
  const std::string html = results_page(sample_results());
  for (const char* part : {"occluded", "offset", "12.69°, 88 %", "near, &quot;odd&quot;.stl",
                           "mine, parametric mesh", "00c0ffee", "magellan is left out"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
}

TEST(ResultsPage, OfOneCellHasItsFiguresWithoutSweeps) {
  Results results = sample_results();
  results.subjects.erase(results.subjects.begin());
  const std::vector<std::string> svgs = svgs_of(results_page(results));
  EXPECT_GE(svgs.size(), 5U);
  for (const std::string& svg : svgs) EXPECT_EQ(xml_fault(svg), "");
}

TEST(ResultsPage, OfNothingIsStillAPage) {
  EXPECT_NE(results_page({}).find("</html>"), std::string::npos);
}

}  // namespace
}  // namespace tumblesight::sim

#include "sim/report/results_files.hpp"

#include "sim/report/results_csv.hpp"
#include "sim/report/results_json.hpp"
#include "sim/report/results_markdown.hpp"
#include "sim/report/results_page.hpp"
#include "sim/terminal/write_file.hpp"

namespace tumblesight::sim {

void write_results_files(const std::string& folder, const Results& results) {
  write_file(folder + "/results.md", results_markdown(results));
  write_file(folder + "/results.csv", results_csv(results));
  write_file(folder + "/results.json", results_json(results).dump(2) + "\n");
  write_file(folder + "/report.html", results_page(results));
}

}  // namespace tumblesight::sim

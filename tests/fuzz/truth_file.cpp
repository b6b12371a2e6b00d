// Files of truth with any content: rows that are written and read again as they are, or a message that names
// file and line.
#include "sim/recording/truth_file.hpp"

#include <stdexcept>

#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {
namespace {

void check(const sim::TruthTable& table) {
  std::vector<sim::RecordedTruth> rows;
  for (const auto& [key, row] : table) {
    require(key.first == row.sequence_number && key.second == row.exposure_time_ns, "a row has its key");
    require(row.q_lrf_trf.coeffs().allFinite(), "an attitude is finite");
    rows.push_back(row);
  }
  const sim::TruthTable again = sim::parse_truth(sim::truth_csv(rows), "again");
  require(again.size() == table.size(), "what is written is read again");
  for (const auto& [key, row] : again) {
    const sim::RecordedTruth& before = table.at(key);
    require((row.q_lrf_trf.coeffs() - before.q_lrf_trf.coeffs()).norm() < 1e-12, "the attitude is the same");
    require(row.rate_lrf_rad_s == before.rate_lrf_rad_s, "the rate is the same");
    require(row.trf_origin_lrf_m == before.trf_origin_lrf_m, "the position is the same");
    require(row.target == before.target, "the target is the same");
    require(row.sensor.has_value() == before.sensor.has_value(), "the sensor is there or not");
    require(!row.sensor || row.sensor->crc32 == before.sensor->crc32, "the sensor is the same");
  }
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  try {
    fuzz::check(sim::parse_truth({data, data + size}, "any.csv"));
  } catch (const std::runtime_error& error) {
    fuzz::require(std::string(error.what()).find("any.csv, line ") == 0, "a message names file and line");
  }
  return 0;
}

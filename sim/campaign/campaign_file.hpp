// Campaign file: which evaluations a campaign consists of, as a TOML file says it. Every key of a [[run]] is
// an option of `tumblesight evaluate` without its dashes; a list makes a run for each of its values.
//
//   seed = 22
//   sequences_per_task = 5000
//
//   [[run]]
//   target = "near_shoemaker"
//   condition = ["nominal", "degraded"]
//   sequences = 400000
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tumblesight::sim {

// One evaluation with one cell.
struct CampaignRun {
  std::string name;                  // of its folder: a-z, 0-9, "_", "-" and "."; unique
  std::vector<std::string> options;  // of `tumblesight evaluate`, with sequences and seed
  // What the file says of them: option without its dashes, and value; none: true.
  std::vector<std::pair<std::string, std::optional<std::string>>> keys;
  std::uint32_t sequences = 0;
  int line = 0;  // of its [[run]] in the file
};

struct Campaign {
  std::string file;    // absolute
  std::string folder;  // of the file: paths in it are relative to it
  std::string name;    // of the file, without its extension
  std::uint32_t sequences_per_task = 0;
  std::vector<CampaignRun> runs;
};

// Throws std::runtime_error if the file cannot be read, and std::invalid_argument that names file, line, key,
// value and limits if something in it is wrong. The options are checked by who runs them.
Campaign read_campaign(const std::string& path);

}  // namespace tumblesight::sim

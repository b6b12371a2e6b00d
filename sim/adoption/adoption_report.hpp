// What an adoption ends with: the verdict as JSON, and the pages.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sim/adoption/adoption.hpp"

namespace tumblesight::sim {

// {"verdict": "GO" or "NO-GO", "reasons": [...], "rows": [as evaluate's], ...}. docs/own_spacecraft.md lists
// the keys.
nlohmann::ordered_json verdict_json(const AdoptionSettings& settings, const AdoptionOutcome& outcome);

// A self-contained page.
std::string adoption_page(const AdoptionSettings& settings, const AdoptionOutcome& outcome);

// verdict.json, report.html and, with a network, evaluation.html in the folder of the settings. Throws as
// write_file does.
void write_adoption_report(const AdoptionSettings& settings, const AdoptionOutcome& outcome,
                           const TriangleMesh& mesh);

}  // namespace tumblesight::sim

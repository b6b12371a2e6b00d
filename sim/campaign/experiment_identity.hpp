// ExperimentIdentity: all that the figures of an evaluation depend on, as the header of a shard file holds
// it. Shards belong together if theirs are equal.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sim/experiment/experiment.hpp"

namespace tumblesight::sim {

struct ExperimentIdentity {
  SubjectDescription subject;
  std::uint32_t mesh_crc32 = 0;
  ExperimentSettings settings;  // its threads say nothing
  std::string version;          // of the program
};

// `version`: of this program.
ExperimentIdentity identity_of(const Subject& subject, const ExperimentSettings& settings,
                               const std::string& version);

// Every number comes back with the same bits. Throws nlohmann::json::exception or std::invalid_argument for
// something else.
nlohmann::ordered_json to_json(const ExperimentIdentity& identity);
ExperimentIdentity identity_from(const nlohmann::ordered_json& json);

// Whether the sequences of one are the first ones of the other. Names of files say nothing.
bool has_same_sequences(const ExperimentIdentity& one, const ExperimentIdentity& other);

// "model_crc32 is 1a2b3c4d, not 5e6f7a8b"; empty if they are equal.
std::string difference(const ExperimentIdentity& other, const ExperimentIdentity& first);

}  // namespace tumblesight::sim

// A small evaluation of a network with arbitrary weights, and its shards.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/campaign/shards.hpp"
#include "sim/report/results_json.hpp"
#include "sim/world/sensor/flash_lidar.hpp"
#include "sim/world/target/targets.hpp"
#include "tests/support/sim_models.hpp"
#include "tests/support/temporary_folder.hpp"

namespace tumblesight::sim {

struct SmallEvaluation {
  SmallEvaluation() {
    subject.target = "near_shoemaker";
    subject.mesh_name = kParametricMesh;
    subject.mesh = target_by_name("near_shoemaker");
    subject.swath_m = swath_m(subject.mesh);
    subject.model_name = "arbitrary";
    subject.model_crc32 = 0x00C0FFEE;
    subject.model = arbitrary_model("near_shoemaker");
    subject.inertia_kg_m2 = Eigen::Vector3d(372.0, 370.0, 316.0).asDiagonal();
    settings.sequences = 13;
    settings.tumbling_sequences = 13;
    settings.frames = 3;
    settings.baseline_sequences = 0;
    settings.seed = 12345678901234567890ULL;
  }

  ShardHeader header(const Shard& shard) const {
    return {identity_of(subject, settings, "1.2.3"), shard, "tumblesight evaluate --sequences 13", "abc"};
  }
  // Runs a shard into a file of the folder, and returns its path.
  std::string run(const Shard& shard, const TemporaryFolder& folder, const std::string& name = {}) const {
    const std::string path = folder.path(
        name.empty() ? "s" + std::to_string(shard.index) + "_" + std::to_string(shard.count) : name);
    ShardWriter file(path, header(shard));
    run_shard(subject, settings, shard, file, [](std::uint64_t) {});
    return path;
  }
  std::string figures_of_one_process() const {
    return text_of(run_experiment(subject, settings, [](std::uint64_t) {}));
  }
  std::string text_of(SubjectResult figures) const {
    Results results;
    results.seed = settings.seed;
    results.subjects.push_back(std::move(figures));
    return results_json(results).dump();
  }
  std::string merged(const std::vector<std::string>& paths) const {
    return text_of(merge_shards(paths).figures);
  }

  Subject subject;
  ExperimentSettings settings;
};

// What an error says, or that there was none.
template <typename Function>
std::string error_of(const Function& function) {
  try {
    function();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace tumblesight::sim

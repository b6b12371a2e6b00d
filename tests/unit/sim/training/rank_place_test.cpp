// Verifies TS-TRN-110.
#include "sim/training/rank_place.hpp"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>
#include <string>

namespace tumblesight::sim {
namespace {

using Environment = std::map<std::string, std::string>;

RankPlace place_in(const Environment& environment) {
  return rank_place([&environment](const char* name) {
    const auto found = environment.find(name);
    return found == environment.end() ? nullptr : found->second.c_str();
  });
}

std::string refusal_of(const Environment& environment) {
  try {
    place_in(environment);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RankPlace, IsAloneWithoutALauncherInABatchScriptAndAsASingleTask) {
  EXPECT_EQ(place_in({}).count, 1);
  EXPECT_EQ(place_in({{"SLURM_NTASKS", "8"}, {"SLURM_PROCID", "0"}}).count, 1);
  EXPECT_EQ(place_in({{"SLURM_NTASKS", "1"}, {"SLURM_PROCID", "0"}, {"SLURM_STEP_ID", "0"}}).count, 1);
  EXPECT_EQ(place_in({{"RANK", "0"}, {"WORLD_SIZE", "1"}}).count, 1);
}

TEST(RankPlace, IsTakenFromSlurmMpirunAndTorchrun) {
  const Environment slurm{{"SLURM_STEP_ID", "0"}, {"SLURM_PROCID", "2"}, {"SLURM_NTASKS", "4"}};
  EXPECT_EQ(place_in(slurm).rank, 2);
  EXPECT_EQ(place_in(slurm).count, 4);
  EXPECT_EQ(place_in(slurm).master_port, 0);
  Environment step = slurm;
  step["SLURM_STEP_NUM_TASKS"] = "3";  // fewer than the job's
  EXPECT_EQ(place_in(step).count, 3);

  Environment mpi = slurm;  // mpirun starts its processes in a step of its own
  mpi["OMPI_COMM_WORLD_RANK"] = "1";
  mpi["OMPI_COMM_WORLD_SIZE"] = "8";
  EXPECT_EQ(place_in(mpi).rank, 1);
  EXPECT_EQ(place_in(mpi).count, 8);

  Environment torchrun = mpi;
  torchrun.insert({{"RANK", "3"}, {"WORLD_SIZE", "16"}, {"MASTER_ADDR", "node1"}, {"MASTER_PORT", "29500"}});
  EXPECT_EQ(place_in(torchrun).rank, 3);
  EXPECT_EQ(place_in(torchrun).count, 16);
  EXPECT_EQ(place_in(torchrun).master_host, "node1");
  EXPECT_EQ(place_in(torchrun).master_port, 29500);
  EXPECT_FALSE(place_in(torchrun).launcher_has_store);
  torchrun["TORCHELASTIC_USE_AGENT_STORE"] = "True";
  EXPECT_TRUE(place_in(torchrun).launcher_has_store);
}

TEST(RankPlace, OfALocalRankComesBeforeThatOfALauncher) {
  Environment environment{{"RANK", "0"}, {"WORLD_SIZE", "16"}, {"MASTER_ADDR", "node1"}};
  for (const std::string& variable : local_rank_environment(1, 2, "/tmp/store")) {
    const std::size_t equals = variable.find('=');
    environment[variable.substr(0, equals)] = variable.substr(equals + 1);
  }
  const RankPlace place = place_in(environment);
  EXPECT_EQ(place.rank, 1);
  EXPECT_EQ(place.count, 2);
  EXPECT_EQ(place.store_file, "/tmp/store");
  EXPECT_EQ(place.master_port, 0);
}

TEST(RankPlace, WhatDoesNotGoTogetherIsRefusedByName) {
  EXPECT_EQ(refusal_of({{"RANK", "1"}}),
            "environment variable RANK is set, but not WORLD_SIZE: set both, or neither");
  EXPECT_EQ(refusal_of({{"RANK", "2"}, {"WORLD_SIZE", "2"}}),
            "environment variable RANK=2: must be a whole number from 0 to 1");
  EXPECT_EQ(refusal_of({{"RANK", "0"}, {"WORLD_SIZE", "0"}}),
            "environment variable WORLD_SIZE=0: must be a whole number from 1 to 65536");
  EXPECT_EQ(refusal_of({{"RANK", "0"}, {"WORLD_SIZE", "two"}}),
            "environment variable WORLD_SIZE=two: must be a whole number from 1 to 65536");
  const Environment two{{"RANK", "0"}, {"WORLD_SIZE", "2"}};
  Environment half = two;
  half["MASTER_ADDR"] = "node1";
  EXPECT_EQ(refusal_of(half),
            "environment variable MASTER_ADDR is set, but not MASTER_PORT: set both, or neither");
  half["MASTER_PORT"] = "70000";
  EXPECT_EQ(refusal_of(half),
            "environment variable MASTER_PORT=70000: must be a whole number from 1 to 65535");
}

}  // namespace
}  // namespace tumblesight::sim

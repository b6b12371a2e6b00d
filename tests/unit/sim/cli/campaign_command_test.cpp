// `tumblesight evaluate --shard`, `merge` and `campaign` as a user runs them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/unit/sim/cli/run_tumblesight.hpp"

namespace tumblesight::sim {
namespace {

class CampaignCommand : public ::testing::Test {
 protected:
  void put_campaign(const std::string& more = "") const {
    std::ofstream(here.path("c.toml"))
        << "seed = 5\nsequences_per_task = 3\n[[run]]\nsequences = 8\nframes = 2\n"
        << "target = \"near_shoemaker\"\nmodel = \"model.tsm\"\n"
        << "condition = [\"nominal\", \"degraded\"]\n"
        << more;
  }
  static std::string crc_in(const std::string& output) {
    const std::size_t at = output.find("figures, CRC-32");
    return at == std::string::npos ? "none" : output.substr(at, 29);
  }
  void expect_refused(const Outcome& outcome, const std::string& message) const {
    EXPECT_NE(outcome.exit_code, 0);
    EXPECT_NE(outcome.errors.find(message), std::string::npos) << outcome.errors;
  }

  const Workplace here{};
  const std::string evaluate =
      "evaluate --no-baseline --sequences 8 --frames 2 --seed 5 --model " + here.model();
};

// Verifies TS-SIL-460.
TEST_F(CampaignCommand, MergedShardsAreTheFileOfOneProcess) {
  EXPECT_EQ(here.run(evaluate + " --json one.json --csv one.csv").exit_code, kGuessed);
  for (const char* shard : {"2/3", "0/3", "1/3"}) {
    const Outcome outcome =
        here.run(evaluate + " --shard " + shard + " --shard-file s" + shard[0] + ".shard");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  }
  const Outcome merged =
      here.run("merge s1.shard s2.shard s0.shard --json all.json --csv all.csv --report r.html");
  EXPECT_EQ(merged.exit_code, kGuessed) << merged.errors;
  EXPECT_EQ(content(here.path("all.json")), content(here.path("one.json")));
  EXPECT_EQ(content(here.path("all.csv")), content(here.path("one.csv")));
  EXPECT_NE(content(here.path("r.html")).find("Worst sequences, nominal"), std::string::npos);
}

TEST_F(CampaignCommand, ShardsRefuseWhatBelongsToTheirMerge) {
  expect_refused(here.run(evaluate + " --shard 0/2"), "--shard requires --shard-file");
  expect_refused(here.run(evaluate + " --shard-file a"), "--shard-file requires --shard");
  expect_refused(here.run(evaluate + " --shard 2/2 --shard-file a"), "'2/2' is no part I/N of the sequences");
  expect_refused(here.run(evaluate + " --shard 0/9 --shard-file a"),
                 "'0/9' are more parts than the 8 sequences");
  expect_refused(here.run(evaluate + " --shard 0/2 --shard-file a --json j"),
                 "give --json to `tumblesight merge`, which does");
  expect_refused(here.run(evaluate + " --shard 0/2 --shard-file a --effect-limit noise"),
                 "leave --shard out");
  expect_refused(here.run("merge model.tsm"), "it is no shard file");
  expect_refused(here.run("merge"), "shards is required");
}

// Verifies TS-SIL-470.
TEST_F(CampaignCommand, ALocalCampaignHasTheFiguresOfItsEvaluations) {
  put_campaign();
  const Outcome outcome = here.run("campaign run c.toml --jobs 2");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(here.run(evaluate + " --condition nominal,degraded --json one.json").exit_code, kGuessed);
  EXPECT_EQ(content(here.path("c/results.json")), content(here.path("one.json")));
  EXPECT_NE(outcome.output.find("simulate --seed 5 --target near_shoemaker --model model.tsm --frames 2 "
                                "--condition degraded --only N"),
            std::string::npos)
      << outcome.output;
  const Outcome again = here.run("campaign run c.toml");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_EQ(again.output.find("started"), std::string::npos) << "nothing is left to do";
  EXPECT_EQ(crc_in(again.output), crc_in(outcome.output));
}

TEST_F(CampaignCommand, WorkersTogetherLeaveNothing) {
  put_campaign();
  const Outcome none = here.run("campaign report c.toml --partial");
  expect_refused(none, "no sequence is done yet");
  EXPECT_EQ(here.run("campaign work c.toml --part 1/2").exit_code, 0);
  expect_refused(here.run("campaign report c.toml"), "--partial reports what there is");
  const Outcome partial = here.run("campaign report c.toml --partial");
  EXPECT_EQ(partial.exit_code, 0) << partial.errors;
  EXPECT_NE(partial.errors.find("near_shoemaker-model_model.tsm-nominal-frames_2: no sequence is done"),
            std::string::npos)
      << partial.errors;
  EXPECT_NE(here.run("campaign status c.toml").output.find("8 of 16 sequences in 6 tasks"),
            std::string::npos);
  EXPECT_EQ(here.run("campaign work c.toml").exit_code, 0);
  EXPECT_EQ(here.run("campaign report c.toml").exit_code, 0);
}

TEST_F(CampaignCommand, EveryRunIsCheckedBeforeTheFirstStarts) {
  put_campaign("[[run]]\nsequences = 1\ntarget = \"near_shoemaker\"\neffect = \"noize=5\"\n");
  const Outcome outcome = here.run("campaign run c.toml");
  expect_refused(outcome, "c.toml, line 9: run near_shoemaker-noize_5: --effect: ");
  EXPECT_FALSE(std::filesystem::exists(here.path("c")));
  put_campaign("[[run]]\nsequences = 1\nmodel = \"none.tsm\"\n");
  expect_refused(here.run("campaign run c.toml"), "line 9: run model_none.tsm: ");
  put_campaign("[[run]]\nsequences = 1\nmoddel = \"none.tsm\"\n");
  expect_refused(here.run("campaign run c.toml"), "line 9: run moddel_none.tsm: ");
}

TEST_F(CampaignCommand, ADryRunOnlyShowsTheRuns) {
  put_campaign();
  const Outcome outcome = here.run("campaign run c.toml --dry-run");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("0 of 16 sequences in 6 tasks"), std::string::npos) << outcome.output;
  EXPECT_FALSE(std::filesystem::exists(here.path("c")));
}

// A task fails in every worker, since a folder has the name of its file; the others are done.
TEST_F(CampaignCommand, WhatIsNotDoneIsNamedWithTheReasonAndTheMessagesOfTheWorkers) {
  put_campaign();
  const std::string run = here.path("c/near_shoemaker-model_model.tsm-nominal-frames_2");
  std::filesystem::create_directories(run);
  std::filesystem::create_symlink(here.path("nowhere/x"), run + "/0001_of_0003.shard");  // cannot be written
  const Outcome outcome = here.run("campaign run c.toml --jobs 1");
  expect_refused(outcome, "1 of 6 tasks are not done, the first: near_shoemaker-model_model.tsm-nominal");
  expect_refused(outcome, "FAILED: near_shoemaker-model_model.tsm-nominal-frames_2 1/3: shard file");
  expect_refused(outcome, "c/logs");
}

TEST_F(CampaignCommand, WhatIsThereOfAnotherExperimentIsNotCounted) {
  put_campaign();
  const std::string shard = "near_shoemaker-model_model.tsm-nominal-frames_2/0001_of_0003.shard";
  EXPECT_EQ(here.run("campaign work c.toml").exit_code, 0);
  const std::string campaign = content(here.path("c.toml"));
  std::ofstream(here.path("c.toml")) << "seed = 6" << campaign.substr(8);
  expect_refused(here.run("campaign run c.toml"),
                 "is of another experiment: seed is 5, not 6; restore the file, mesh, model or program that "
                 "it was begun with, or give another --out");
  expect_refused(here.run("campaign report c.toml"), "is of another command: ");
  std::ofstream(here.path("c.toml")) << campaign;
  here.put("c/" + shard, {1, 2, 3});
  expect_refused(here.run("campaign run c.toml"), "it is no shard file");
}

TEST_F(CampaignCommand, ADamagedRecordIsRunAgain) {
  put_campaign();
  const Outcome first = here.run("campaign run c.toml");
  const std::string path = here.path("c/near_shoemaker-model_model.tsm-nominal-frames_2/0001_of_0003.shard");
  std::string bytes = content(path);
  bytes[bytes.size() - 1] ^= 1;
  std::ofstream(path, std::ios::binary) << bytes;
  const Outcome again = here.run("campaign run c.toml");
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_NE(again.errors.find("begin with an incomplete or damaged record; what they held is run again"),
            std::string::npos)
      << again.errors;
  EXPECT_EQ(crc_in(again.output), crc_in(first.output));
}

// While another task is left to do, too: one call does both.
TEST_F(CampaignCommand, ADamagedRecordIsRunAgainBesideWhatIsLeft) {
  put_campaign();
  const Outcome first = here.run("campaign run c.toml");
  const std::string folder = here.path("c/near_shoemaker-model_model.tsm-nominal-frames_2/");
  std::string bytes = content(folder + "0001_of_0003.shard");
  bytes[bytes.size() - 1] ^= 1;
  std::ofstream(folder + "0001_of_0003.shard", std::ios::binary) << bytes;
  std::filesystem::remove(folder + "0002_of_0003.shard");
  const Outcome partial = here.run("campaign report c.toml --partial");
  EXPECT_NE(partial.errors.find("0001_of_0003.shard is damaged. The "), std::string::npos) << partial.errors;
  const Outcome again = here.run("campaign run c.toml");
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(crc_in(again.output), crc_in(first.output));
}

// The other runs have figures all the same.
TEST_F(CampaignCommand, ARunOfWhichNothingIsWholeDoesNotPreventAPartialReport) {
  put_campaign();
  const std::string folder = here.path("c/near_shoemaker-model_model.tsm-nominal-frames_2/");
  EXPECT_EQ(here.run("campaign work c.toml").exit_code, 0);
  for (const char* shard : {"0001_of_0003.shard", "0002_of_0003.shard"})
    std::filesystem::remove(folder + shard);
  std::string bytes = content(folder + "0000_of_0003.shard");
  const std::size_t header = bytes.find("}\n") + 2 + 4;
  bytes[header + 20] ^= 1;
  std::ofstream(folder + "0000_of_0003.shard", std::ios::binary) << bytes;
  const Outcome partial = here.run("campaign report c.toml --partial");
  EXPECT_EQ(partial.exit_code, 0) << partial.errors;
  EXPECT_NE(partial.errors.find("nominal-frames_2: no sequence is done."), std::string::npos)
      << partial.errors;
}

// Its commands would differ from those of what is done, and the report has room for one.
TEST_F(CampaignCommand, AnotherSpellingOfAPathIsNotedBeforeTheWork) {
  const std::string toml =
      "sequences_per_task = 1\n[[run]]\nsequences = 2\nframes = 1\ntarget = \"near_shoemaker\"\n";
  std::ofstream(here.path("c.toml")) << toml << "model = \"model.tsm\"\n";
  EXPECT_EQ(here.run("campaign work c.toml --part 0/2").exit_code, 0);
  std::ofstream(here.path("c.toml")) << toml << "model = \"./model.tsm\"\n";
  const Outcome outcome = here.run("campaign run c.toml");
  expect_refused(outcome, "is of another command: tumblesight evaluate --no-baseline --sequences 2 --seed 1");
  expect_refused(outcome,
                 "restore the file, mesh, model or program that it was begun with, or give another --out");
}

TEST_F(CampaignCommand, WhatWasDoneWithAnotherDivisionIsNamed) {
  put_campaign();
  EXPECT_EQ(here.run("campaign work c.toml --part 0/6").exit_code, 0);
  const std::string campaign = content(here.path("c.toml"));
  std::ofstream(here.path("c.toml")) << std::string(campaign).replace(campaign.find("task = 3"), 8,
                                                                      "task = 4");
  const Outcome outcome = here.run("campaign run c.toml");
  expect_refused(outcome,
                 "_of_0003.shard' is of a campaign with other sequences or sequences_per_task, which divide "
                 "the run into 2 shards now");
}

TEST_F(CampaignCommand, KeysThatAreNoOptionsAreNamedWithTheRemedy) {
  const std::pair<const char*, const char*> kRows[] = {
      {"sequences_per_task = 2", "sequences_per_task is for all runs: write it at the top, before [[run]]"},
      {"mesh_scale = 2", "there is no option 'mesh_scale'"},
      {"mesh_scale = 2", "did you mean 'mesh-scale'?"},
      {"help = true", "there is no option 'help'"},
      {"mesh = true", "mesh: needs a value, not true"},
      {"frames = true", "frames: needs a value, not true"},
      {"free-attitude = \"yes\"", "there is no option 'free-attitude'"},
      {"no-ego-motion = \"yes\"", "no-ego-motion: must be true, not 'yes'"},
      {"sensor = \"list\"", "sensor: 'list' shows what there is"},
      {"effect = \"list\"", "effect: 'list' shows what there is"},
      {"inertia = [1, 2, 3, 0, 0, 0]",
       "inertia: a list makes a run for each of its values; write its 6 numbers"}};
  for (const auto& [line, message] : kRows) {
    std::ofstream(here.path("k.toml")) << "[[run]]\nsequences = 2\n" << line << "\n";
    const Outcome outcome = here.run("campaign run k.toml --dry-run");
    expect_refused(outcome, message);
    expect_refused(outcome, "k.toml, line 1: run ");
  }
}

TEST_F(CampaignCommand, TwoCampaignsDoNotShareAFolder) {
  for (const char* name : {"a.toml", "b.toml"})
    std::ofstream(here.path(name)) << "[[run]]\nsequences = 1\nframes = 1\nmodel = \"model.tsm\"\n";
  EXPECT_EQ(here.run("campaign run a.toml --out both").exit_code, 0);
  expect_refused(here.run("campaign run b.toml --out both"),
                 "both' is of the campaign 'a'; give another --out, or delete '");
  expect_refused(here.run("campaign report b.toml --out both"), "both' is of the campaign 'a'");
}

TEST_F(CampaignCommand, ItsMarkdownHasEveryRunWithBoundsAndTheWorst) {
  std::ofstream(here.path("e.toml")) << "[[run]]\nsequences = 2\nframes = 1\nmodel = \"model.tsm\"\n"
                                     << "effect = [\"noise=4\", \"rays=32,noise=2\"]\n";
  EXPECT_EQ(here.run("campaign run e.toml").exit_code, 0);
  const std::string text = content(here.path("e/results.md"));
  for (const char* part : {"| nominal, noise=4 | 2 |", "| nominal, rays=32,noise=2 | 2 |", "%) |",
                           "### Worst sequences, nominal, noise=4", " --only "})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST_F(CampaignCommand, AFolderThatCannotBeMadeIsNamed) {
  put_campaign();
  std::ofstream(here.path("c")) << "a file";
  expect_refused(here.run("campaign run c.toml"), "c/logs' cannot be made: ");
}

// Of a closed stream the number is free for the next file, which would get what is meant for the stream.
TEST_F(CampaignCommand, AClosedStreamDoesNotEndUpInAShardFile) {
  const std::string line = evaluate + " --shard 0/1 --shard-file s.shard";
  EXPECT_EQ(here.run_command("(" TUMBLESIGHT_BINARY " " + line + " 2>&-)", "closed").exit_code, 0);
  EXPECT_EQ(here.run("merge s.shard").exit_code, kGuessed) << "all sequences are there";
  EXPECT_EQ(content(here.path("s.shard")).find("shard 0/1 "), std::string::npos);
}

TEST_F(CampaignCommand, NotesThatCannotBeShownAreNoFailure) {
  put_campaign();
  const Outcome outcome =
      here.run_command("(" TUMBLESIGHT_BINARY " campaign run c.toml 2>/dev/full)", "full");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(std::filesystem::exists(here.path("c/report.html")));
}

TEST_F(CampaignCommand, FilesAreWrittenThoughNobodyReadsTheTables) {
  const Outcome outcome = here.run_command("(" TUMBLESIGHT_BINARY " " + evaluate +
                                               " --condition nominal,degraded,occluded,tumbling --json "
                                               "j.json --csv c.csv --report r.html >/dev/full)",
                                           "full");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.errors.find("standard output: "), std::string::npos) << outcome.errors;
  for (const char* file : {"j.json", "c.csv", "r.html"})
    EXPECT_TRUE(std::filesystem::exists(here.path(file))) << file;
}

TEST_F(CampaignCommand, WhatIsNotUtf8IsRefusedBeforeTheWork) {
  const Outcome outcome = here.run("evaluate --sequences 1 --model 'sonde_\xe4.tsm'");
  EXPECT_EQ(outcome.exit_code, kBadArguments);
  EXPECT_NE(outcome.errors.find("'sonde_?.tsm': is not UTF-8"), std::string::npos) << outcome.errors;
}

TEST_F(CampaignCommand, AShardFileIsAPlainFile) {
  ASSERT_EQ(here.run_command("mkfifo pipe", "mkfifo").exit_code, 0);
  expect_refused(here.run(evaluate + " --shard 0/2 --shard-file pipe"),
                 "it is no plain file; name another one");
  expect_refused(here.run(evaluate + " --shard 0/2 --shard-file /dev/null"), "it is no plain file");
}

TEST_F(CampaignCommand, ShardsWithoutASequenceAreNotMerged) {
  EXPECT_EQ(here.run(evaluate + " --shard 0/2 --shard-file s.shard").exit_code, 0);
  const std::string bytes = content(here.path("s.shard"));
  const std::size_t end = bytes.find("}\n");
  ASSERT_NE(end, std::string::npos);
  std::ofstream(here.path("s.shard"), std::ios::binary) << bytes.substr(0, end + 2 + 4);
  expect_refused(here.run("merge --partial s.shard --json j.json"),
                 "no sequence is done in shard file 's.shard'");
  EXPECT_FALSE(std::filesystem::exists(here.path("j.json")));
}

TEST_F(CampaignCommand, ARunIsOneEvaluationAndResultsDoNotReplaceTheCampaign) {
  std::ofstream(here.path("two.toml")) << "[[run]]\nsequences = 2\ncondition = \"nominal,degraded\"\n";
  expect_refused(here.run("campaign run two.toml"),
                 "it is several evaluations; write the conditions as a list");
  std::ofstream(here.path("plain")) << "[[run]]\nsequences = 2\n";
  expect_refused(here.run("campaign run plain"),
                 "has no extension .toml, so its results would take its name");
}

// One experiment can be written in several ways.
TEST_F(CampaignCommand, RunsWithTheSameSequencesAreRefused) {
  for (const std::string two : {"condition = [\"nominal\", \"nominal\"]\n", "frames = [2, 3, 2]\n",
                                "effect = [\"rays=32,noise=2\", \"noise=2.0,rays=32\"]\n",
                                "[[run]]\nsequences = 3\ncondition = \"nominal\"\n",
                                "[[run]]\nsequences = 2\nmesh = \"parametric\"\n"}) {
    std::ofstream(here.path("twice.toml")) << "[[run]]\nsequences = 2\n" << two;
    expect_refused(here.run("campaign run twice.toml --dry-run"),
                   "which would count twice; leave out one of them");
  }
}

TEST_F(CampaignCommand, SensorsOfOneNameAreRefused) {
  for (const char* folder : {"a", "b"}) std::filesystem::create_directory(here.path(folder));
  const std::string sensor = content(TUMBLESIGHT_SOURCE_DIR "/sim/world/sensor/descriptions/flash_256.json");
  std::ofstream(here.path("a/s.json")) << sensor;
  const std::size_t at = sensor.find("\"noise\"");
  ASSERT_NE(at, std::string::npos);
  const std::size_t digit = sensor.find_first_of("123456789", at);
  std::ofstream(here.path("b/s.json"))
      << std::string(sensor).replace(digit, 1, sensor[digit] == '5' ? "4" : "5");
  std::ofstream(here.path("two.toml")) << "[[run]]\nsequences = 2\nsensor = [\"a/s.json\", \"b/s.json\"]\n";
  expect_refused(here.run("campaign run two.toml --dry-run"),
                 "its sensor has the name 'flash_256' and is another one");
}

// Slurm's commands as they answer on a federation of clusters, with warnings.
class FakeSlurm : public CampaignCommand {
 protected:
  FakeSlurm() {
    std::filesystem::create_directories(here.path("bin"));
    put_program("squeue", "echo 'squeue: warning: slow' >&2; echo 'CLUSTER: big'; echo \"$*\" >> asked\n");
    put_program("scancel", "echo \"$*\" > cancelled\n");
    put_campaign();
  }
  void put_program(const std::string& name, const std::string& script) const {
    const std::string path = here.path("bin/" + name);
    std::ofstream(path) << "#!/bin/sh\ncd " << here.path("") << "\n" << script;
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }
  // Submitted jobs are in the file `submitted`, a line each.
  void put_sbatch() const {
    put_program("sbatch",
                "case \"$*\" in *--version*) ;; *) echo \"$*\" >> submitted; echo '17;big';; esac\n");
  }
  Outcome run(const std::string& options = "") const {
    return here.run_command(
        "env PATH=bin:$PATH " TUMBLESIGHT_BINARY " campaign run c.toml --on slurm " + options, "a");
  }
  std::size_t arrays() const {
    const std::string submitted = content(here.path("submitted"));
    std::size_t count = 0;
    for (std::size_t at = 0; (at = submitted.find("--array=", at)) != std::string::npos; ++at) ++count;
    return count;
  }
};

TEST_F(FakeSlurm, AnArrayWithoutItsReportIsCancelled) {
  put_program("sbatch",
              "case \"$*\" in *--version*) ;; *--wrap*) echo 'QOSMaxSubmitJobPerUserLimit' >&2; exit 1;; "
              "*) echo 'sbatch: note; nothing' >&2; echo '17;big';; esac\n");
  const Outcome outcome = run();
  expect_refused(outcome, "QOSMaxSubmitJobPerUserLimit. Job array 17;big was cancelled");
  EXPECT_EQ(outcome.errors.find("slurm-client"), std::string::npos);
  EXPECT_EQ(content(here.path("cancelled")), "-M big 17\n");
}

TEST_F(FakeSlurm, AnArrayThatCannotBeCancelledIsNamedBesideTheCause) {
  put_program("sbatch",
              "case \"$*\" in *--version*) ;; *--wrap*) echo 'QOSMaxSubmitJobPerUserLimit' >&2; exit 1;; "
              "*) echo 17;; esac\n");
  put_program("scancel", "echo 'Access denied' >&2; exit 1\n");
  const Outcome outcome = run();
  expect_refused(outcome, "QOSMaxSubmitJobPerUserLimit. Job array 17 goes on, since scancel");
  expect_refused(outcome, "Access denied; to end it: scancel 17");
}

// Its text would be taken for a number, the jobs for gone, and others submitted.
TEST_F(FakeSlurm, AnAnswerThatIsNoNumberIsQuotedAndNothingSubmittedAgain) {
  for (const char* answer : {"", "17\\nNOTE: your quota is 90%%", ";big"}) {
    std::filesystem::remove(here.path("submitted"));
    put_program("sbatch",
                std::string("case \"$*\" in *--version*) ;; *) echo \"$*\" >> submitted; printf '") + answer +
                    "\\n';; esac\n");
    const Outcome outcome = run();
    expect_refused(outcome,
                   "in place of a job's number. Slurm may have taken the job: end what `squeue --name=c`");
    EXPECT_EQ(arrays(), 1U) << answer;
  }
}

TEST_F(FakeSlurm, JobsThatEndWithoutResultsAreNotWaitedForForever) {
  put_sbatch();
  expect_refused(run(), "parts 0,1,2,3,4,5 of the array are not done");
  EXPECT_EQ(content(here.path("asked")).rfind("-M big -h -j 17 -o %i %j\n", 0), 0U);
  EXPECT_EQ(arrays(), 3U);
}

// Ctrl-C or a lost terminal ends only the progress. The fake squeue does the work when it is asked again.
TEST_F(FakeSlurm, JobsOfAnEarlierCallAreFollowedToTheEnd) {
  put_sbatch();
  EXPECT_NE(run("--no-wait").output.find("Slurm job array 17;big, and job 17;big"), std::string::npos);
  put_program("squeue",
              "[ -e worked ] && exit; [ -e asked ] && " TUMBLESIGHT_BINARY
              " campaign work c.toml >worked; echo >> asked; echo 'CLUSTER: big'; echo '17_[0-5] c'\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(
      outcome.output.find("nothing new: the Slurm jobs 17;big and 17;big of an earlier call go on, with "
                          "the options of that call. To submit others: scancel -M big 17 17"),
      std::string::npos)
      << outcome.output;
  EXPECT_EQ(arrays(), 1U);
  EXPECT_TRUE(std::filesystem::exists(here.path("c/report.html")));
}

TEST_F(FakeSlurm, JobsOfAnEarlierCallThatHaveEndedAreSubmittedAgain) {
  put_sbatch();
  run("--no-wait");
  EXPECT_EQ(run("--no-wait").output.find("an earlier call"), std::string::npos);
  EXPECT_EQ(arrays(), 2U);
  put_program("squeue", "echo '17_[0-5] another'\n");
  run("--no-wait");
  EXPECT_EQ(arrays(), 3U) << "another job has the number";
}

// A controller that does not answer, a cluster that has another name now.
TEST_F(FakeSlurm, WithoutAnAnswerNothingIsSubmittedTwice) {
  put_sbatch();
  run("--no-wait");
  put_program("squeue", "echo 'slurm_load_jobs error: Unable to contact slurm controller' >&2; exit 1\n");
  const Outcome outcome = run("--no-wait");
  expect_refused(outcome, "whether the Slurm jobs 17;big and 17;big of an earlier call go on is not known");
  EXPECT_NE(outcome.errors.find("Unable to contact slurm controller"), std::string::npos);
  EXPECT_NE(outcome.errors.find("slurm/jobs' to submit new ones"), std::string::npos);
  EXPECT_EQ(arrays(), 1U);
  std::filesystem::remove(here.path("c/slurm/jobs"));
  EXPECT_EQ(run("--no-wait").exit_code, 0);
  EXPECT_EQ(arrays(), 2U);
}

// Ctrl-C reaches the foreground process group. A shell starts background processes without SIGINT.
TEST_F(FakeSlurm, ASubmissionIsFinishedBeforeTheCommandStops) {
  put_program("sbatch",
              "case \"$*\" in *--version*) ;; *) touch asked_to; sleep 1; echo \"$*\" >> submitted; "
              "echo '17;big';; esac\n");
  const Outcome outcome = here.run_command("sh -c 'PATH=bin:$PATH setsid " TUMBLESIGHT_BINARY
                                           " campaign run c.toml --on slurm & while [ ! -e asked_to ]; do "
                                           "sleep 0.01; done; env kill -TERM -- -$!; "
                                           "wait $!'",
                                           "a");
  EXPECT_EQ(outcome.exit_code, kStopped) << outcome.errors;
  EXPECT_EQ(content(here.path("c/slurm/jobs")), "17;big 17;big\n");
}

TEST_F(FakeSlurm, WaitsForAnotherCallThatSubmitsUntilItIsStopped) {
  put_sbatch();
  std::filesystem::create_directories(here.path("c/slurm"));
  const Outcome outcome = here.run_command(
      "sh -c 'flock c/slurm/jobs sleep 5 & sleep 0.3; PATH=bin:$PATH timeout --preserve-status -s INT "
      "1.5 " TUMBLESIGHT_BINARY " campaign run c.toml --on slurm'",
      "a");
  EXPECT_EQ(outcome.exit_code, kStopped);
  EXPECT_NE(outcome.errors.find("waiting for another call"), std::string::npos) << outcome.errors;
  EXPECT_EQ(arrays(), 0U);
}

TEST_F(CampaignCommand, WaysThatAreNotThereAreNamed) {
  put_campaign();
  expect_refused(
      here.run_command("env PATH=/nowhere " TUMBLESIGHT_BINARY " campaign run c.toml --on slurm", "a"),
      "sbatch cannot be started: No such file or directory; the machine must be one from which jobs");
  expect_refused(
      here.run_command("env PATH=/nowhere " TUMBLESIGHT_BINARY " campaign run c.toml --on mpi", "a"),
      "mpirun cannot be started: No such file or directory; install an MPI (Debian: openmpi-bin)");
  expect_refused(here.run("campaign run c.toml --on lsf"), "local, mpi");
  expect_refused(here.run("campaign run c.toml --options x"), "give --on slurm or --on mpi");
  expect_refused(here.run("campaign run c.toml --no-wait"), "is for --on slurm");
}

}  // namespace
}  // namespace tumblesight::sim

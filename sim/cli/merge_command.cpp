#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "sim/campaign/shards.hpp"
#include "sim/cli/evaluation_output.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

struct MergeArguments {
  std::vector<std::string> shards;
  ResultsFiles files;
  bool partial = false;
};

OptionFiles files_read(const std::vector<std::string>& shards) {
  OptionFiles files;
  for (const std::string& shard : shards) files.push_back({"the shard files", shard});
  return files;
}

void merge(const MergeArguments& arguments) {
  require_usable_files(files_read(arguments.shards), files_written(arguments.files));
  MergedShards merged =
      merge_shards(arguments.shards, arguments.partial ? MergeMode::kPartial : MergeMode::kComplete);
  announce(merged.identity.subject, merged.identity.settings);
  Results results;
  results.seed = merged.identity.settings.seed;
  results.command = merged.command;
  results.generated = local_time_text();
  results.notes = merged.notes;
  note_builds(merged.commits, results.notes);
  results.subjects.push_back(std::move(merged.figures));
  for (const std::string& note : results.notes) print_note(note);
  write_files(arguments.files, results);  // first: what is printed may have no reader any more
  print_results(results);
  const bool wrong = print_mostly_wrong(results.subjects.front()) != nullptr;
  print_report_path(arguments.files);
  if (wrong) throw Exit(kOfNoUse);
}

}  // namespace

void add_merge_command(Command& app, const std::string&) {
  Command command = add_verb(app, "merge");
  auto arguments = std::make_shared<MergeArguments>();
  command.add_option("shards", arguments->shards, "all shard files of one evaluation, in any order")
      ->required()
      ->check(existing_file())
      ->type_name("FILE");
  command.add_flag("--partial", arguments->partial,
                   "make the figures from the sequences that are done, although some are missing");
  add_results_options(command, arguments->files);
  command.footer(
      "\nTables, JSON, CSV and report are those of one process, bit for bit, whatever the\n"
      "number of shards and their order; only times differ. Refused, by name: shards of\n"
      "another evaluation (target, mesh, model, sensor, seed and so on), a sequence\n"
      "that is in two files, one that is in none, and a shard that is not finished.\n\n"
      "The exit status is 4 if more than half of the attitudes in the last frame of a\n"
      "condition are wrong, as with `tumblesight evaluate`.\n\n"
      "Example: two machines, half of the sequences each\n"
      "  tumblesight evaluate --sequences 10000 --shard 0/2 --shard-file half0.shard\n"
      "  tumblesight evaluate --sequences 10000 --shard 1/2 --shard-file half1.shard\n"
      "  tumblesight merge half0.shard half1.shard --json figures.json\n\n"
      "`tumblesight campaign` does this for many evaluations, on a cluster too.\n");
  command.callback([arguments] { merge(*arguments); });
}

}  // namespace tumblesight::sim

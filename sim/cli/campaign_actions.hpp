// What the subcommands of `tumblesight campaign` do.
#pragma once

#include <cstdint>
#include <string>

namespace tumblesight::sim {

struct CampaignArguments {
  std::string file;
  std::string out;  // empty: the file's path without its extension
  std::string on = "local";
  std::uint32_t jobs = 0;
  std::string options;
  bool no_wait = false;
  bool dry_run = false;
  bool partial = false;
  std::string part;
  bool supervised = false;
  std::string command_line;
};

// Each throws std::invalid_argument or std::runtime_error that says what to do, or Exit with the status.
void run_campaign(const CampaignArguments& arguments);      // what is not done yet, then the report
void work_on_campaign(const CampaignArguments& arguments);  // as one worker, until no task is left
void print_campaign(const CampaignArguments& arguments);    // how far each run is
void report_campaign(const CampaignArguments& arguments);   // of the shard files

}  // namespace tumblesight::sim

// tumblesight: the ground tool, with one subcommand per job.
#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include "cmake/version.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/verbs.hpp"
#ifdef TUMBLESIGHT_HAS_SIL
#include "hal/dds/idl/icd_hash.hpp"
#endif

namespace {

using tumblesight::sim::kBadArguments;
using tumblesight::sim::kFailed;

int report(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  // --help, and commands that have already reported their failure.
  if (error.get_exit_code() == 0 || error.get_name() == "RuntimeError") return app.exit(error);
  if (error.get_name() == "RequiredError" && argc > 1 && argv[1][0] != '-' && app.get_subcommands().empty()) {
    std::fprintf(stderr, "tumblesight: there is no subcommand '%s' (see tumblesight --help)\n", argv[1]);
    return kBadArguments;
  }
  std::string help = "tumblesight";
  for (const CLI::App* command : app.get_subcommands()) help += " " + command->get_name();
  std::fprintf(stderr, "tumblesight: %s (see %s --help)\n", error.what(), help.c_str());
  return kBadArguments;
}

// A failure of the output makes a success a failure.
int finish_output(int status) {
  const bool written = std::cout.flush().good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written) return status;
  std::fprintf(stderr, "tumblesight: standard output: %s\n", std::strerror(errno));
  return status == 0 ? kFailed : status;
}

// Program version, commit, format version of model images, hash of the interface definition: one per line.
std::string version_text() {
  std::string text = std::string("tumblesight ") + tumblesight::kVersion + "\ncommit " +
                     tumblesight::kCommit + "\nmodel format " +
                     std::to_string(tumblesight::gnc::kModelFormatVersion<tumblesight::gnc::FixedPoint>);
#ifdef TUMBLESIGHT_HAS_SIL
  char hash[16];
  std::snprintf(hash, sizeof hash, "%08x", static_cast<unsigned>(tumblesight::hal::dds::icd_hash()));
  text += std::string("\ninterface ") + hash;
#endif
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace tumblesight;
  CLI::App app{"Tumblesight: attitude of tumbling spacecraft from flash-LiDAR frames."};
  app.name("tumblesight");
  app.set_version_flag("--version", version_text(), "version, commit, model format and interface hash");
  app.require_subcommand(1);
  app.formatter(std::make_shared<sim::HelpFormatter>());
  try {
    std::string command_line = "tumblesight";
    for (int i = 1; i < argc; ++i) command_line += std::string(" ") + argv[i];
    sim::add_verbs(app, command_line);
    app.footer(
        "\nStart with\n  tumblesight simulate\n"
        "and see `tumblesight SUBCOMMAND --help` for the options of each.\n");
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return finish_output(report(app, error, argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tumblesight: %s\n", error.what());
    return kFailed;
  }
  return finish_output(0);
}

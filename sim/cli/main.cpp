// tumblesight: the ground tool, with one subcommand per job.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <typeinfo>

#include "cmake/version.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "sim/cli/absent_verbs.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/exit_status.hpp"
#include "sim/cli/parse_faults.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/process/program_files.hpp"
#include "sim/terminal/text.hpp"
#ifdef TUMBLESIGHT_HAS_SIL
#include "hal/dds/idl/icd_hash.hpp"
#endif

namespace {

using tumblesight::sim::kBadArguments;
using tumblesight::sim::kFailed;

int report(const CLI::App& app, const CLI::ParseError& error) {
  // --help, and commands that have already reported their failure.
  if (error.get_exit_code() == 0 || error.get_name() == "RuntimeError") return app.exit(error);
  std::fprintf(stderr, "tumblesight: %s\n", tumblesight::sim::fault_of_parsing(app, error).c_str());
  return kBadArguments;
}

// A file that is opened later must not take the place of a standard stream that is closed, and get its text.
// It is opened for reading, so that writing to it still fails.
void reserve_standard_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
    if (fcntl(stream, F_GETFD) < 0) (void)open("/dev/null", O_RDONLY);  // takes the lowest number
}

// Arguments end up in reports and JSON.
void require_utf8(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (!tumblesight::sim::is_utf8(argv[i]))
      throw CLI::ValidationError(
          fmt::format("argument '{}'", tumblesight::sim::shortened(argv[i])),
          "is not UTF-8, which reports and JSON are written in; if it is a file, give it another name");
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

#ifdef TUMBLESIGHT_FULL_PROGRAM
// Goes on in the program with all verbs, which lists them in its help and refuses those that do not exist.
void start_full_program(char** argv) {
  const auto full = tumblesight::sim::program_path().parent_path() / TUMBLESIGHT_FULL_PROGRAM;
  execv(full.c_str(), argv);
  throw std::runtime_error(full.string() + ": " + std::strerror(errno) +
                           "; build the target tumblesight again");
}

bool is_version_or_verb(const CLI::App& app, const std::string& argument) {
  const auto is_it = [&argument](const CLI::App* verb) { return verb->get_name() == argument; };
  return argument == "--version" || !app.get_subcommands(is_it).empty();
}
#endif

}  // namespace

int main(int argc, char** argv) {
  using namespace tumblesight;
  reserve_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a limit of file sizes is an error of the file, as a full disk is
  CLI::App app{"Tumblesight: attitude of tumbling spacecraft from flash-LiDAR frames."};
  app.name("tumblesight");
  app.set_version_flag("--version", version_text(), "version, commit, model format and interface hash");
  app.require_subcommand(1);
  app.formatter(std::make_shared<sim::HelpFormatter>());
  try {
    require_utf8(argc, argv);
    std::string command_line = "tumblesight";
    for (int i = 1; i < argc; ++i) command_line += " " + sim::shell_word(argv[i]);
    sim::add_verbs(app, command_line);
#ifdef TUMBLESIGHT_FULL_PROGRAM
    if (argc < 2 || !is_version_or_verb(app, argv[1])) start_full_program(argv);
#else
    sim::add_libtorch_verbs(app, command_line);
#endif
    app.footer(
        "\nStart with\n  tumblesight simulate\n"
        "and see `tumblesight SUBCOMMAND --help` for the options of each.\n" +
        sim::absent_verbs_text(app));
    if (const std::string fault = argc > 1 ? sim::fault_of_absent_verb(app, argv[1]) : ""; !fault.empty()) {
      std::fprintf(stderr, "tumblesight: %s\n", fault.c_str());
      return finish_output(kBadArguments);
    }
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return finish_output(report(app, error));
  } catch (const std::exception& error) {
    // fmt::print() does not say to what it could not write.
    const bool is_of_output = typeid(error) == typeid(std::system_error) && std::ferror(stdout) != 0;
    std::fprintf(stderr, "tumblesight: %s%s\n", is_of_output ? "standard output: " : "", error.what());
    return kFailed;
  }
  return finish_output(0);
}

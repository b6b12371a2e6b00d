// Command lines of `tumblesight`, all subcommands with their options and help: they are parsed, or refused
// with a message. The subcommands themselves do not run.
#include <CLI/CLI.hpp>
#include <memory>

#include "sim/cli/verbs.hpp"
#include "tests/fuzz/arguments.hpp"

namespace tumblesight::fuzz {
namespace {

std::unique_ptr<CLI::App> make_tool() {
  auto tool = std::make_unique<CLI::App>("", "tumblesight");
  tool->require_subcommand(1);
  using namespace sim;
  Command command(*tool);
  for (AddCommand* add : {TUMBLESIGHT_ADD_COMMANDS}) add(command, "");
  tool->parse_complete_callback([] { throw CLI::Success(); });  // before any subcommand does its work
  return tool;
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  using namespace tumblesight::fuzz;
  static Reused reused(make_tool);
  CLI::App* const tool = &reused.get();
  CommandLine line(Input(data, size));
  try {
    tool->parse(line.argc(), line.argv());
  } catch (const CLI::CallForHelp&) {
    require(!tool->help().empty(), "there is help");
  } catch (const CLI::Success&) {
    require(!tool->get_subcommands().empty(), "there is something to do");
  } catch (const CLI::ParseError& error) {
    require(error.get_exit_code() != 0 && error.what()[0] != '\0', "a refusal says why");
  } catch (const sim::ArgumentFault& fault) {
    require(fault.what()[0] != '\0', "a refusal says why");
  } catch (const sim::Exit& exit) {  // of --effect list
    require(exit.status == 0, "a list is no failure");
  }
  return 0;
}

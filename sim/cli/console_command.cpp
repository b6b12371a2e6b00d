#include <fmt/format.h>
#include <poll.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "hal/dds/idl/domain.hpp"
#include "hal/dds/idl/run_secret.hpp"
#include "sim/cli/arguments.hpp"
#include "sim/cli/target_setup.hpp"
#include "sim/cli/verbs.hpp"
#include "sim/console/bus_run.hpp"
#include "sim/console/console_server.hpp"
#include "sim/console/recorded_run.hpp"
#include "sim/console/ros2_bridge.hpp"
#include "sim/host/interruption.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

constexpr int kDefaultPort = 7320;

struct ConsoleArguments {
  std::string recording;  // empty: the bus
  int domain = -1;
  int port = kDefaultPort;
  std::optional<std::uint32_t> ros2_domain;  // without: not published to ROS 2
  std::string security, model, mcap;
  bool is_of_run = false;  // sim/run --watch started it, with the run
};

std::string make_token() {
  hal::dds::RunSecret secret;
  if (!hal::dds::make_run_secret(secret)) throw std::runtime_error("the system provides no random numbers");
  return secret.partition;
}

std::unique_ptr<RunSource> open_run(const ConsoleArguments& arguments) {
  if (arguments.recording.empty())
    return std::make_unique<BusRun>(arguments.domain, arguments.security, arguments.mcap);
  if (!arguments.mcap.empty()) throw ArgumentFault("--mcap", "records a run on the bus; this is a recording");
  if (arguments.domain >= 0) throw ArgumentFault("--domain", "is of a run on the bus; a recording has none");
  return std::make_unique<RecordedRun>(arguments.recording);
}

std::unique_ptr<Ros2Bridge> open_ros2(const ConsoleArguments& arguments, const RunSource& run) {
  if (!arguments.ros2_domain) return nullptr;
  return std::make_unique<Ros2Bridge>(run, *arguments.ros2_domain);
}

// Notes a failure that has not been told yet.
void tell(const std::string& failure, std::string& told) {
  if (failure != told && !failure.empty()) print_message("tumblesight: " + failure);
  told = failure;
}

// The image of a target: the one given, or the one shipped if there is one.
Requests::ModelOf model_of(const ConsoleArguments& arguments) {
  const std::string given = arguments.model;
  return [given](const std::string& target) {
    if (!given.empty() || target.empty()) return given;
    const std::string shipped = shipped_model_path(target);
    std::error_code error;
    return std::filesystem::is_regular_file(shipped, error) ? shipped : std::string();
  };
}

// After "Ctrl-C ends the console".
const char* what_goes_on(const ConsoleArguments& arguments) {
  if (arguments.is_of_run) return " and the run";
  return arguments.recording.empty() ? "; the run goes on" : "";
}

void show(const ConsoleArguments& arguments) {
  if (!arguments.model.empty()) ConsoleTarget{arguments.model};  // throws what is wrong with it
  if (!arguments.mcap.empty()) require_usable_files({}, {{"--mcap", arguments.mcap}});
  const std::unique_ptr<RunSource> run = open_run(arguments);
  const std::string token = make_token();
  const std::unique_ptr<Ros2Bridge> ros2 = open_ros2(arguments, *run);
  const Requests requests(*run, model_of(arguments), token);
  const Interruption interruption;
  const ConsoleServer server(requests, arguments.port);
  fmt::print(
      "\n  {}\n\n  http://127.0.0.1:{}/?token={}\n\n  Open this address in a browser. Ctrl-C ends the "
      "console{}.\n",
      run->title(), server.port(), token, what_goes_on(arguments));
  if (ros2) fmt::print("  ROS 2 nodes see the run in ROS domain {}.\n", *arguments.ros2_domain);
  if (!run->is_whole())
    fmt::print("  The recording has no end: its writer was killed, or has not ended yet.\n");
  std::fflush(stdout);
  const auto* const bus = dynamic_cast<const BusRun*>(run.get());
  std::string told_of_bus, told_of_ros2;
  while (Interruption::signal() == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (bus != nullptr) tell(bus->failure(), told_of_bus);
    if (!ros2) continue;
    ros2->poll();
    tell(ros2->failure(), told_of_ros2);
  }
}

}  // namespace

void add_console_command(Command& app, const std::string&) {
  Command command = add_verb(app, "console");
  auto arguments = std::make_shared<ConsoleArguments>();
  command
      .add_option("RECORDING", arguments->recording,
                  "file of simulate, replay or record with --mcap [the run on this machine's bus]")
      ->check(file_path());
  limit_whole_number(command.add_option("--domain", arguments->domain,
                                        "DDS domain of the run [the newest run that you have started]"),
                     0, hal::dds::kMaxDomain);
  limit_whole_number(
      command.add_option("--port", arguments->port, "of 127.0.0.1; 0: a free one")->capture_default_str(), 0,
      65535);
  command
      .add_option("--mcap", arguments->mcap,
                  "also record the run to FILE, from where the console joins it; a recording that can be "
                  "replayed is made by simulate --mcap")
      ->check(file_path())
      ->type_name("FILE");
  limit_whole_number(
      command
          .add_option("--ros2", arguments->ros2_domain,
                      "also publish the run to the ROS 2 nodes of this machine with this ROS_DOMAIN_ID; "
                      "docs/console.md has their settings")
          ->type_name("DOMAIN"),
      0, Ros2Bridge::kMostDomain);
  command
      .add_option("--model", arguments->model,
                  "model image that has the target's surface and scale [the one shipped for the target]")
      ->check(existing_file());
  command
      .add_option("--dds-security", arguments->security,
                  "of a secured bus; hal/dds/make_security writes the file")
      ->check(existing_file());
  command.add_flag("--of-run", arguments->is_of_run)->group("");
  command.footer(
      "\nExample: in one terminal a run at the speed of flight, in another the console\n"
      "  tumblesight simulate --sequences 30 --speed 10\n"
      "  tumblesight console\n\n"
      "Example: a run as a file, then the same page with it\n"
      "  tumblesight simulate --sequences 30 --mcap run.mcap\n"
      "  tumblesight console run.mcap\n\n"
      "The console may start before the run, come late or leave: the run does not wait\n"
      "for it. It answers on this machine only, and only at the address with its token.\n"
      "docs/console.md explains the page and its keys. The exit status is 0 after\n"
      "Ctrl-C, 1 if the recording, the port or the ROS domain cannot be used, 2 for\n"
      "wrong arguments.");
  command.callback([arguments] { show(*arguments); });
}

}  // namespace tumblesight::sim

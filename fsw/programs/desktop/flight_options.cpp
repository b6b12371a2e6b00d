#include "fsw/programs/desktop/flight_options.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <tuple>

#include "cmake/version.hpp"
#include "fsw/programs/desktop/flight_program.hpp"
#include "gnc/rcnn/model_image.hpp"
#include "hal/dds/idl/domain.hpp"
#include "hal/dds/idl/icd_hash.hpp"
#include "hal/dds/idl/run_secret.hpp"

namespace tumblesight::fsw::desktop {
namespace {

bool fail(const char* option, const char* value, const char* expected) {
  std::fprintf(stderr, "%s: %s '%s': expected %s\n", kProgramName, option, value, expected);
  return false;
}

bool parse_integer(const char* option, const char* value, std::uint32_t max, std::uint32_t& result) {
  char* end = nullptr;
  errno = 0;
  const unsigned long long number = std::strtoull(value, &end, 10);
  if (end == value || *end != '\0' || value[0] == '-' || errno != 0 || number > max) {
    char expected[48];
    std::snprintf(expected, sizeof expected, "a whole number from 0 to %u", max);
    return fail(option, value, expected);
  }
  result = static_cast<std::uint32_t>(number);
  return true;
}

bool parse_number(const char* option, const char* value, double min, double max, double& result) {
  char* end = nullptr;
  result = std::strtod(value, &end);
  if (end == value || *end != '\0' || !std::isfinite(result) || result < min || result > max) {
    char expected[64];
    std::snprintf(expected, sizeof expected, "a number from %g to %g", min, max);
    return fail(option, value, expected);
  }
  return true;
}

bool parse_mode(const char* option, const char* value, bool& free_running) {
  free_running = std::strcmp(value, "free-running") == 0;
  return free_running || std::strcmp(value, "lockstep") == 0 ||
         fail(option, value, "lockstep or free-running");
}

bool parse_numerics(const char* option, const char* value, FlightOptions& options) {
  options.numerics_given = true;
  options.float32 = std::strcmp(value, "float32") == 0;
  if (kFlyFloat32) return options.float32 || fail(option, value, "float32; for fixed point start flight");
  return options.float32 || std::strcmp(value, "fixed") == 0 || fail(option, value, "fixed or float32");
}

bool parse_path(const char* option, const char* value, char* path) {
  const std::size_t length = std::strlen(value);
  if (length == 0 || length >= FlightOptions::kMaxPath) return fail(option, value, "a file's path");
  std::memcpy(path, value, length + 1);
  return true;
}

// As in the header of a model image.
bool is_target_name(const char* value) {
  const std::size_t length = std::strlen(value);
  return length > 0 && length < std::tuple_size_v<decltype(gnc::ModelHeader::target)> &&
         std::strspn(value, "abcdefghijklmnopqrstuvwxyz0123456789_") == length;
}

bool parse_reset(const char* option, const char* value, hal::ResetCause& cause) {
  const bool watchdog = std::strcmp(value, "watchdog") == 0;
  cause = watchdog ? hal::ResetCause::kWatchdog : hal::ResetCause::kPowerOn;
  return watchdog || std::strcmp(value, "power-on") == 0 || fail(option, value, "power-on or watchdog");
}

// A simulator that starts this program passes run id and partition in the environment.
bool read_environment(FlightOptions& options) {
  // No other thread runs yet. NOLINTNEXTLINE(concurrency-mt-unsafe)
  const char* const text = std::getenv(hal::dds::kRunSecretVariable);
  if (text == nullptr) return true;
  hal::dds::RunSecret secret;
  if (!hal::dds::read_run_secret(text, secret)) {
    std::fprintf(stderr, "%s: %s: expected a run id, a colon and 32 hexadecimal digits\n", kProgramName,
                 hal::dds::kRunSecretVariable);
    return false;
  }
  options.run_id = secret.run_id;
  std::memcpy(options.partition, secret.partition, sizeof options.partition);
  return true;
}

bool parse_one(const char* option, const char* value, FlightOptions& options) {
  if (std::strcmp(option, "--model") == 0) {
    options.model_given = true;
    return parse_path(option, value, options.model_path);
  }
  if (std::strcmp(option, "--command-key") == 0) return parse_path(option, value, options.command_key_path);
  if (std::strcmp(option, "--packets") == 0) return parse_path(option, value, options.packets_path);
  if (std::strcmp(option, "--state") == 0) return parse_path(option, value, options.state_path);
  if (std::strcmp(option, "--reset") == 0) {
    options.reset_given = true;
    return parse_reset(option, value, options.reset_cause);
  }
  if (std::strcmp(option, "--dds-security") == 0) return parse_path(option, value, options.security_path);
  if (std::strcmp(option, "--target") == 0) {
    options.target = value;
    return is_target_name(value) || fail(option, value, "1 to 31 characters of a-z, 0-9 and _");
  }
  if (std::strcmp(option, "--numerics") == 0) return parse_numerics(option, value, options);
  if (std::strcmp(option, "--domain") == 0)
    return parse_integer(option, value, hal::dds::kMaxDomain, options.domain);
  if (std::strcmp(option, "--run-id") == 0) return parse_integer(option, value, UINT32_MAX, options.run_id);
  if (std::strcmp(option, "--mode") == 0) return parse_mode(option, value, options.free_running);
  if (std::strcmp(option, "--period-ms") == 0) {
    options.period_given = true;
    return parse_number(option, value, 1.0, 60'000.0, options.period_ms);
  }
  if (std::strcmp(option, "--timeout-s") == 0)
    return parse_number(option, value, 0.1, 86'400.0, options.timeout_s);
  // For the test of the refusal; not in the help.
  if (std::strcmp(option, "--icd-hash") == 0)
    return parse_integer(option, value, UINT32_MAX, options.icd_hash);
  std::fprintf(stderr, "%s: unknown option %s\n", kProgramName, option);
  return false;
}

// An option that depends on another one.
bool check_needed_options(const FlightOptions& options) {
  const char* problem = nullptr;
  if (options.reset_given && options.state_path[0] == '\0') problem = "--reset has no effect without --state";
  if (options.period_given && !options.free_running)
    problem = "--period-ms has no effect without --mode free-running";
  if (problem != nullptr) std::fprintf(stderr, "%s: %s\n", kProgramName, problem);
  return problem == nullptr;
}

bool finish_output() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return true;
  std::fprintf(stderr, "%s: standard output: %s\n", kProgramName, strerrordesc_np(errno));
  return false;
}

}  // namespace

bool print_flight_help() {
  std::printf(
      "%s: the Tumblesight flight application on a desktop, connected to a\n"
      "simulator over DDS (loopback)%s\n\n"
      "  --model FILE       model image [the one shipped for the target]\n"
      "  --target NAME      target that the model image must be for [near_shoemaker]\n"
      "  --numerics N       fixed: fixed point, as flown; float32: the reference\n"
      "                     [%s]\n"
      "  --command-key FILE key that signs telecommands, 64 hexadecimal digits\n"
      "                     [the public development key]\n"
      "  --packets FILE     also write the telemetry to FILE as CCSDS space packets;\n"
      "                     replaces a file of such packets, no other file\n"
      "  --state FILE       keep mode, bank, limits and command counter in FILE and\n"
      "                     FILE.copy [not kept]\n"
      "  --reset CAUSE      with --state: power-on or watchdog, why flight was started\n"
      "                     [power-on]\n"
      "  --domain N         DDS domain [0]\n"
      "  --run-id N         simulator run to join; 0: the first one found [0]\n"
      "  --dds-security FILE\n"
      "                     secures the bus; hal/dds/make_security writes the file\n"
      "                     [not secured]\n"
      "  --mode MODE        lockstep: the simulator sets the time;\n"
      "                     free-running: cycles on a timer [lockstep]\n"
      "  --period-ms N      free-running: wall-clock period of a cycle [2700]\n"
      "  --timeout-s N      end after this long without a simulator or a step from it\n"
      "                     [60]\n"
      "  --version          version, commit, model format and interface hash\n"
      "  --help             this text\n\n"
      "Exit status: 0 complete, 1 standard output cannot be written, 2 bad arguments\n"
      "or files, 3 interface definitions differ, 4 simulator gone, 5 timeout, 6 DDS\n"
      "failed, 7 step out of order, 8 the flight task used the heap, 9 no thread for\n"
      "the flight task, 10 flight_float32 cannot be started, 11 another program writes\n"
      "to the topics of the run, 12 telemetry packets could not be written, 13 the\n"
      "simulator expects another target or model image, 14 another flight program is on\n"
      "the DDS domain, 130 interrupted (SIGINT), 143 asked to stop (SIGTERM).\n",
      kProgramName,
      kFlyFloat32 ? ".\nThis is its variant in float32, for comparisons. Start `flight`: for a float32\n"
                    "image it starts this one"
                  : "",
      kFlyFloat32 ? "float32, nothing else" : "fixed; with --model: as the image");
  return finish_output();
}

bool print_flight_version() {
  std::printf("%s %s\ncommit %s\nmodel format %d\ninterface %08x\n", kProgramName, kVersion, kCommit,
              int{gnc::kModelFormatVersion<gnc::FixedPoint>}, static_cast<unsigned>(hal::dds::icd_hash()));
  return finish_output();
}

ParseResult parse_flight_options(int argc, char** argv, FlightOptions& options) {
  options.icd_hash = hal::dds::icd_hash();
  if (!read_environment(options)) return ParseResult::kError;
  for (int i = 1; i < argc; i += 2) {
    if (std::strcmp(argv[i], "--version") == 0) return ParseResult::kVersion;
    if (std::strcmp(argv[i], "--help") == 0 || std::strcmp(argv[i], "-h") == 0) return ParseResult::kHelp;
    if (i + 1 == argc) {
      std::fprintf(stderr, "%s: %s: unknown option, or its value is missing\n", kProgramName, argv[i]);
      return ParseResult::kError;
    }
    if (!parse_one(argv[i], argv[i + 1], options)) return ParseResult::kError;
  }
  return check_needed_options(options) ? ParseResult::kRun : ParseResult::kError;
}

}  // namespace tumblesight::fsw::desktop

// A simulator that runs until the test kills it, at most a minute. Arguments: model image, flight program,
// file for flight's messages, DDS domain, and after how many steps it ends by itself. Writes flight's process
// id to the standard output.
#include <cstdio>
#include <cstdlib>

#include "tests/sil/sil_test_support.hpp"

namespace {

using namespace tumblesight::sim;

void simulate(int argc, char** argv) {
  SilSettings settings;
  settings.target = test::kTarget;
  settings.model_path = argv[1];
  settings.flight_path = argv[2];
  settings.flight_log_path = argv[3];
  settings.domain = std::atoi(argv[4]);
  test::Conversation conversation(settings);
  conversation.step();
  std::printf("%d\n", static_cast<int>(conversation.session.flight_pid()));
  std::fflush(stdout);
  const int steps = argc == 6 ? std::atoi(argv[5]) : 1200;
  for (int i = 0; i < steps; ++i) {
    conversation.step();
    conversation.session.sleep_until(SilSession::Clock::now() + std::chrono::milliseconds(50));
  }
  conversation.finish();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5 && argc != 6) return 2;
  try {
    simulate(argc, argv);
  } catch (const SilFailure& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 1;
  }
}

// A simulator that runs until the test kills it, at most a minute. Arguments: model image, flight program,
// file for flight's messages, DDS domain. Writes flight's process id to the standard output.
#include <cstdio>
#include <cstdlib>

#include "tests/sil/sil_test_support.hpp"

int main(int argc, char** argv) {
  using namespace tumblesight::sim;
  if (argc != 5) return 2;
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
  for (int i = 0; i < 1200; ++i) {
    conversation.step();
    conversation.session.sleep_until(SilSession::Clock::now() + std::chrono::milliseconds(50));
  }
}

// That no two runs on the machine have the same DDS domain.
#include "sim/sil/domain_lease.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <set>
#include <vector>

#include "sim/sil/failure.hpp"
#include "tests/sil/sil_test_support.hpp"

namespace tumblesight::sim {
namespace {

// A process that takes a domain, tells it, and keeps it until the other end of `go_on` is closed.
pid_t start_holder(int result, int go_on, int wanted, void (*prepare)(int), int argument) {
  const pid_t child = fork();
  if (child != 0) return child;
  prepare(argument);
  std::int32_t domain = -1;
  try {
    const DomainLease lease(wanted);
    domain = static_cast<std::int32_t>(lease.domain());
    char end = 0;
    if (write(result, &domain, sizeof domain) == sizeof domain) (void)!read(go_on, &end, 1);
  } catch (const SilFailure&) {
    (void)!write(result, &domain, sizeof domain);
  }
  _exit(0);
}

// The domains of `count` processes that live at the same time; -1: it got none.
std::vector<std::int32_t> domains_of(int count, int wanted, void (*prepare)(int)) {
  int results[2], go_on[2];
  EXPECT_EQ(pipe(results), 0);
  EXPECT_EQ(pipe(go_on), 0);
  std::vector<pid_t> holders;
  for (int i = 0; i < count; ++i) holders.push_back(start_holder(results[1], go_on[0], wanted, prepare, i));
  std::vector<std::int32_t> domains(static_cast<std::size_t>(count), -2);
  for (std::int32_t& domain : domains) EXPECT_EQ(read(results[0], &domain, sizeof domain), 4);
  for (const pid_t holder : holders) kill(holder, SIGKILL);
  for (const pid_t holder : holders) waitpid(holder, nullptr, 0);
  for (const int end : {results[0], results[1], go_on[0], go_on[1]}) close(end);
  return domains;
}

// The folders of a program are no part of a lease.
void have_other_folders(int i) {
  setenv("TMPDIR", ("/nonexistent/" + std::to_string(i)).c_str(), 1);
  setenv("XDG_RUNTIME_DIR", ("/nonexistent/run" + std::to_string(i)).c_str(), 1);
}

// Verifies TS-SIL-020.
TEST(DomainLease, OfFiftyProcessesAreFiftyDomains) {
  const std::vector<std::int32_t> domains = domains_of(50, -1, have_other_folders);
  const std::set<std::int32_t> distinct(domains.begin(), domains.end());
  EXPECT_EQ(distinct.size(), 50U);
  EXPECT_GE(*distinct.begin(), 1);
}

// Verifies TS-SIL-050.
TEST(DomainLease, OfADomainIsGivenToOneProcess) {
  const std::vector<std::int32_t> domains = domains_of(8, test::spare_domain(), have_other_folders);
  EXPECT_EQ(std::count(domains.begin(), domains.end(), -1), 7);
}

// Verifies TS-SIL-050.
TEST(DomainLease, OfADomainIsGivenToOneUser) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  const std::vector<std::int32_t> domains =
      domains_of(4, test::spare_domain(), [](int i) { (void)!setuid(static_cast<uid_t>(65530 + i)); });
  EXPECT_EQ(std::count(domains.begin(), domains.end(), -1), 3);
}

// Verifies TS-SIL-050.
TEST(DomainLease, ThatIsTakenIsNamed) {
  const DomainLease lease(test::spare_domain());
  try {
    const DomainLease second(static_cast<int>(lease.domain()));
    ADD_FAILURE() << "taken twice";
  } catch (const SilFailure& failure) {
    EXPECT_EQ(std::string(failure.what())
                  .find("DDS domain " + std::to_string(lease.domain()) +
                        " is in use: another run, or another program, on this machine"),
              0U);
  }
}

// All UDP ports of a domain that DDS participants try, as another program may have them.
std::vector<int> occupy_ports_of(std::uint32_t domain) {
  constexpr int kFirst = 7400, kPerDomain = 250, kPorts = 100;
  std::vector<int> sockets;
  for (int i = 0; i < kPorts; ++i) {
    sockets.push_back(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(kFirst + kPerDomain * static_cast<int>(domain) + i));
    (void)bind(sockets.back(), reinterpret_cast<const sockaddr*>(&address), sizeof address);
  }
  return sockets;
}

// Verifies TS-SIL-050.
TEST(DomainLease, WhosePortsAnotherProgramHasIsGivenBackForTheNext) {
  const std::uint32_t domain = DomainLease(-1).domain();
  const std::vector<int> sockets = occupy_ports_of(domain);
  const std::string number = std::to_string(domain);
  const std::string printed = test::simulate("--frames 3");
  // Unless a test beside this one has taken the domain in between.
  if (printed.find("Failed to find a free participant index for domain " + number) != std::string::npos) {
    EXPECT_NE(printed.find("note: DDS domain " + number + " could not be opened: "), std::string::npos)
        << printed;
    EXPECT_NE(printed.find("; the run is in domain "), std::string::npos) << printed;
  }
  EXPECT_EQ(printed.find("give another --domain"), std::string::npos) << printed;
  for (const int one : sockets) close(one);
}

}  // namespace
}  // namespace tumblesight::sim

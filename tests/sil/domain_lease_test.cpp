// That no two runs on the machine have the same DDS domain.
#include "sim/sil/domain_lease.hpp"

#include <gtest/gtest.h>
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

}  // namespace
}  // namespace tumblesight::sim

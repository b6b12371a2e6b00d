#include "sim/training/gloo_ranks.hpp"

#include <netdb.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <vector>

// The class is declared only where LibTorch's own macro says that it was built with Gloo.
#ifndef USE_C10D_GLOO
#define USE_C10D_GLOO
#endif
#include <torch/csrc/distributed/c10d/ProcessGroupGloo.hpp>

#include "sim/training/rank_store.hpp"

namespace tumblesight::sim {
namespace {

using c10d::ProcessGroupGloo;
using StorePtr = c10::intrusive_ptr<c10d::Store>;
using Device = std::shared_ptr<::gloo::transport::Device>;

std::string first_line(const std::exception& error) {
  const std::string text = error.what();
  return text.substr(0, text.find('\n'));
}

// Runs an operation that needs the other ranks.
template <typename Operation>
void together(int rank, const Operation& operation) {
  try {
    operation();
  } catch (const std::exception& error) {
    throw RankLost("rank " + std::to_string(rank) + ": another rank has ended or does not answer (" +
                   first_line(error) + "). The same command continues from the last checkpoint");
  }
}

class GlooRanks final : public Ranks {
 public:
  GlooRanks(int rank, int count, int sharing_cores, c10::intrusive_ptr<ProcessGroupGloo> group)
      : Ranks(rank, count, sharing_cores), group_(std::move(group)) {}

 private:
  // Each rank adds up one slice of all ranks, so that what a rank sends does not grow with their number.
  void sum_flat(torch::Tensor& flat) override {
    const std::int64_t size = flat.numel();
    const std::int64_t slice = (size + count() - 1) / count();
    torch::Tensor sent = torch::zeros({slice * count()});
    sent.narrow(0, 0, size).copy_(flat);
    torch::Tensor received = torch::empty_like(sent);
    std::vector<std::int64_t> equal_split;
    together(rank(), [&] { group_->alltoall_base(received, sent, equal_split, equal_split)->wait(); });
    std::vector<torch::Tensor> slices = received.view({count(), slice}).unbind(0);
    add_up(slices);
    flat.copy_(gather_rows(slices.front()).view(-1).narrow(0, 0, size));
  }

  void broadcast(torch::Tensor& tensor) override {
    std::vector<torch::Tensor> tensors{tensor};
    together(rank(), [&] { group_->broadcast(tensors)->wait(); });
  }

  torch::Tensor gather_rows(const torch::Tensor& row) override {
    std::vector<std::int64_t> sizes = row.sizes().vec();
    sizes.insert(sizes.begin(), count());
    const torch::Tensor rows = torch::empty(sizes, row.options());
    std::vector<std::vector<torch::Tensor>> outputs{rows.unbind(0)};
    std::vector<torch::Tensor> inputs{row.contiguous()};
    together(rank(), [&] { group_->allgather(outputs, inputs)->wait(); });
    return rows;
  }

  c10::intrusive_ptr<ProcessGroupGloo> group_;
};

// Equal for two processes that reach each other through the loopback interface.
std::string this_machine() {
  std::string boot;
  std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
  std::error_code none;
  return boot + " " + std::filesystem::read_symlink("/proc/self/ns/net", none).string();
}

std::string these_cores() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  std::string list;
  if (sched_getaffinity(0, sizeof cores, &cores) != 0) return list;
  for (int i = 0; i < CPU_SETSIZE; ++i) list += CPU_ISSET(i, &cores) ? '1' : '0';
  return list;
}

// What each rank says of itself, by rank.
std::vector<std::string> exchange(c10d::Store& store, const RankPlace& place, const std::string& key,
                                  const std::string& own) {
  store.set(key + std::to_string(place.rank), std::vector<std::uint8_t>(own.begin(), own.end()));
  std::vector<std::string> all;
  for (int rank = 0; rank < place.count; ++rank) {
    const std::vector<std::uint8_t> text = store.get(key + std::to_string(rank));
    all.emplace_back(text.begin(), text.end());
  }
  return all;
}

struct Freer {
  void operator()(addrinfo* list) const { freeaddrinfo(list); }
};

// The numeric address from which this machine reaches `host`. Nothing is sent.
std::string address_towards(const std::string& host) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), "9", &hints, &found) != 0 || found == nullptr)
    throw std::runtime_error("MASTER_ADDR=" + host + " is not known");
  const std::unique_ptr<addrinfo, Freer> list(found);
  const int probe = socket(list->ai_family, SOCK_DGRAM, 0);
  sockaddr_storage own{};
  socklen_t size = sizeof own;
  char text[NI_MAXHOST] = "";
  if (connect(probe, list->ai_addr, list->ai_addrlen) == 0 &&
      getsockname(probe, reinterpret_cast<sockaddr*>(&own), &size) == 0) {
    getnameinfo(reinterpret_cast<sockaddr*>(&own), size, text, sizeof text, nullptr, 0, NI_NUMERICHOST);
  }
  close(probe);
  return text;
}

// On which address this rank listens for the others.
Device device_for(const RankPlace& place, bool one_machine) {
  if (one_machine) return ProcessGroupGloo::createDeviceForHostname("127.0.0.1");
  if (const char* name = std::getenv("GLOO_SOCKET_IFNAME"))
    return ProcessGroupGloo::createDeviceForInterface(name);
  if (place.master_port == 0) return ProcessGroupGloo::createDefaultDevice();
  const std::string address = address_towards(place.master_host);
  if (address.empty() || address.rfind("127.", 0) == 0) {
    throw std::runtime_error("MASTER_ADDR=" + place.master_host +
                             " leads to no address that other machines reach; set GLOO_SOCKET_IFNAME to the "
                             "name of a network interface");
  }
  return ProcessGroupGloo::createDeviceForHostname(address);
}

c10::intrusive_ptr<ProcessGroupGloo> connect_all(const RankPlace& place, const StorePtr& store,
                                                 bool one_machine, std::chrono::milliseconds timeout) {
  auto options = ProcessGroupGloo::Options::create(timeout);
  options->threads = 1;
  options->devices.push_back(device_for(place, one_machine));
  return c10::make_intrusive<ProcessGroupGloo>(store, place.rank, place.count, options);
}

std::shared_ptr<Ranks> join(const RankPlace& place, const std::string& folder,
                            std::chrono::milliseconds timeout) {
  const StorePtr store = open_rank_store(place, folder, timeout);
  const std::vector<std::string> machines = exchange(*store, place, "machine/", this_machine());
  const std::vector<std::string> cores =
      exchange(*store, place, "cores/", this_machine() + " " + these_cores());
  const auto own = static_cast<std::size_t>(place.rank);
  const bool one_machine = std::count(machines.begin(), machines.end(), machines[own]) == place.count;
  const auto sharing = static_cast<int>(std::count(cores.begin(), cores.end(), cores[own]));
  return std::make_shared<GlooRanks>(place.rank, place.count, sharing,
                                     connect_all(place, store, one_machine, timeout));
}

}  // namespace

std::shared_ptr<Ranks> join_gloo_ranks(const RankPlace& place, const std::string& folder, double timeout_s) {
  const std::chrono::milliseconds timeout(static_cast<std::int64_t>(1e3 * timeout_s));
  if (!place.store_file.empty()) prctl(PR_SET_PDEATHSIG, SIGTERM);  // stops with its supervisor
  try {
    return join(place, folder, timeout);
  } catch (const std::exception& error) {
    throw RankLost("rank " + std::to_string(place.rank) + ": the " + std::to_string(place.count) +
                   " ranks have not found each other (" + first_line(error) +
                   "). Were all of them started, and does --rank-timeout leave them enough time?");
  }
}

}  // namespace tumblesight::sim

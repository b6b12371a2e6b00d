#include "sim/training/gloo_ranks.hpp"

#include <netdb.h>
#include <sched.h>
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

#include "sim/host/end_with_starter.hpp"
#include "sim/training/rank_store.hpp"
#include "sim/training/shared_slots.hpp"

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

// A larger tensor is sent; 16 MiB.
constexpr std::int64_t kMostInMemory = 4'194'304;

class GlooRanks final : public Ranks {
 public:
  GlooRanks(int rank, int count, int sharing_cores, bool one_machine,
            c10::intrusive_ptr<ProcessGroupGloo> group, std::chrono::milliseconds timeout)
      : Ranks(rank, count, sharing_cores),
        group_(std::move(group)),
        timeout_(timeout),
        shares_memory_(one_machine) {}

 private:
  void sum_flat(torch::Tensor& flat) override {
    if (has_slots(flat.numel())) return sum_in_memory(flat);
    sum_by_messages(flat);
  }

  // Each rank adds up one slice of all ranks, so that what a rank sends does not grow with their number. Sent
  // from and received into place.
  void sum_by_messages(const torch::Tensor& flat) {
    std::vector<torch::Tensor> slices, received;
    for (int i = 0; i < count(); ++i) {
      const Share share = share_of(flat.numel(), i, count());
      slices.push_back(flat.narrow(0, share.first, share.count));
    }
    torch::Tensor& own = slices[static_cast<std::size_t>(rank())];
    for (int i = 0; i < count(); ++i) received.push_back(i == rank() ? own : torch::empty_like(own));
    exchange(slices, received);
    add_up(received);
    if (rank() != 0) own.copy_(received.front());
    exchange(std::vector<torch::Tensor>(slices.size(), own), slices);
  }

  // Every rank adds up everything, since the ranks then wait for each other once only.
  void sum_in_memory(torch::Tensor& flat) {
    slots_->begin_turn();
    const auto slot = [&](int rank) { return slots_->slot(rank, flat.numel()); };
    slot(rank()).copy_(flat);
    together(rank(), [&] { slots_->meet(timeout_); });
    std::vector<torch::Tensor> pairs{flat};
    torch::add_out(pairs.front(), slot(0), slot(1));
    for (int i = 2; i + 1 < count(); i += 2) pairs.push_back(slot(i) + slot(i + 1));
    if (count() % 2 == 1) pairs.push_back(slot(count() - 1).clone());
    add_up(pairs);
  }

  // Whether the ranks exchange `size` numbers in memory. All of them find the same.
  bool has_slots(std::int64_t size) {
    if (!shares_memory_ || size > kMostInMemory) return false;
    if (slots_ && slots_->size() >= size) return true;
    slots_.reset();
    const std::string own_name = "/tumblesight_" + std::to_string(getpid()) + "_" + std::to_string(size);
    if (leads()) slots_ = SharedSlots::create(own_name, count(), size);
    const std::string name = of_first(slots_ ? own_name : std::string());
    if (!leads() && !name.empty()) slots_ = SharedSlots::open(name, rank(), count(), size);
    shares_memory_ = !any(slots_ == nullptr);  // all have opened it
    if (leads() && !name.empty()) SharedSlots::forget(name);
    if (!shares_memory_) slots_.reset();
    return shares_memory_;
  }

  // To each other rank the tensor at its place, and from it the one at its place.
  void exchange(std::vector<torch::Tensor> sent, std::vector<torch::Tensor> received) {
    constexpr int kTag = 0;
    together(rank(), [&] {
      std::vector<c10::intrusive_ptr<c10d::Work>> works;
      for (int i = 0; i < count(); ++i) {
        if (i == rank()) continue;
        const auto at = static_cast<std::size_t>(i);
        std::vector<torch::Tensor> from{received[at]}, to{sent[at]};
        if (from.front().numel() > 0) works.push_back(group_->recv(from, i, kTag));
        if (to.front().numel() > 0) works.push_back(group_->send(to, i, kTag));
      }
      for (const auto& work : works) work->wait();
    });
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
  std::chrono::milliseconds timeout_;
  bool shares_memory_;
  std::unique_ptr<SharedSlots> slots_;
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
  return std::make_shared<GlooRanks>(place.rank, place.count, sharing, one_machine,
                                     connect_all(place, store, one_machine, timeout), timeout);
}

}  // namespace

std::shared_ptr<Ranks> join_gloo_ranks(const RankPlace& place, const std::string& folder, double timeout_s) {
  const std::chrono::milliseconds timeout(static_cast<std::int64_t>(1e3 * timeout_s));
  if (!place.store_file.empty()) end_with_starter();  // its supervisor
  try {
    return join(place, folder, timeout);
  } catch (const std::exception& error) {
    throw RankLost("rank " + std::to_string(place.rank) + ": the " + std::to_string(place.count) +
                   " ranks have not found each other (" + first_line(error) +
                   "). Were all of them started, and does --rank-timeout leave them enough time?");
  }
}

}  // namespace tumblesight::sim

#include "sim/training/rank_store.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>
#include <thread>
#include <torch/csrc/distributed/c10d/FileStore.hpp>
#include <torch/csrc/distributed/c10d/PrefixStore.hpp>
#include <torch/csrc/distributed/c10d/TCPStore.hpp>

#include "sim/host/write_file.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;
using StorePtr = c10::intrusive_ptr<c10d::Store>;
using Clock = std::chrono::steady_clock;

constexpr char kInvitation[] = "ranks.invitation";  // the name of the store's file
constexpr char kStore[] = "ranks.store.";           // and a word that no other run has

std::string new_word() {
  std::random_device random;
  return std::to_string(random()) + "." + std::to_string(random());
}

std::vector<std::uint8_t> bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

std::string first_word(const fs::path& path) {
  std::string word;
  std::ifstream(path) >> word;
  return word;
}

StorePtr tcp_store(const RankPlace& place, std::chrono::milliseconds timeout) {
  c10d::TCPStoreOptions options;
  options.port = static_cast<std::uint16_t>(place.master_port);
  options.isServer = place.rank == 0 && !place.launcher_has_store;
  options.numWorkers = static_cast<std::size_t>(place.count);
  options.waitWorkers = !place.launcher_has_store;
  options.timeout = timeout;
  return c10::make_intrusive<c10d::PrefixStore>(
      place.store_prefix, c10::make_intrusive<c10d::TCPStore>(place.master_host, options));
}

StorePtr file_store(const fs::path& path, const RankPlace& place, std::chrono::milliseconds timeout) {
  auto store = c10::make_intrusive<c10d::FileStore>(path.string(), place.count);
  store->setTimeout(timeout);
  return store;
}

void remove_left_files(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (name == kInvitation || name.rfind(kStore, 0) == 0) fs::remove(entry.path());
  }
}

std::string guest_key(int rank) {
  return "guest/" + std::to_string(rank);
}
std::string welcome_key(const std::string& word) {
  return "welcome/" + word;
}

// Rank 0 opens a new store, invites the others to it and answers each of them.
StorePtr invite(const RankPlace& place, const fs::path& folder, std::chrono::milliseconds timeout) {
  fs::create_directories(folder);
  remove_left_files(folder);
  const std::string name = kStore + new_word();
  StorePtr store = file_store(folder / name, place, timeout);
  store->set("open", bytes_of("yes"));  // creates the file
  write_file((folder / kInvitation).string(), name + '\n');
  for (int rank = 1; rank < place.count; ++rank) {
    const std::vector<std::uint8_t> word = store->get(guest_key(rank));
    store->set(welcome_key({word.begin(), word.end()}), bytes_of("welcome"));
  }
  fs::remove(folder / kInvitation);
  return store;
}

constexpr std::chrono::milliseconds kSoon{500};

bool is_welcome(c10d::Store& store, const std::string& word) {
  try {
    store.wait({welcome_key(word)}, kSoon);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

// Opens the store of the invitation. While there is no answer it may be that of a killed run, so that a new
// invitation counts instead.
StorePtr accept(const RankPlace& place, const fs::path& folder, std::chrono::milliseconds timeout) {
  const std::string word = new_word();
  const auto deadline = Clock::now() + timeout;
  StorePtr store;
  std::string opened;
  while (Clock::now() < deadline) {
    const std::string name = first_word(folder / kInvitation);
    if (!name.empty() && name != opened && fs::exists(folder / name)) {
      store.reset();
      if (!opened.empty()) fs::remove(folder / opened);
      store = file_store(folder / name, place, kSoon);  // its file may be gone at any moment
      store->set(guest_key(place.rank), bytes_of(word));
      opened = name;
    }
    if (store && is_welcome(*store, word)) {
      store->setTimeout(timeout);
      return store;
    }
    if (!store) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  throw std::runtime_error("rank 0 has not opened " + (folder / kInvitation).string());
}

}  // namespace

StorePtr open_rank_store(const RankPlace& place, const std::string& folder,
                         std::chrono::milliseconds timeout) {
  if (!place.store_file.empty()) return file_store(place.store_file, place, timeout);
  if (place.master_port != 0) return tcp_store(place, timeout);
  return place.rank == 0 ? invite(place, folder, timeout) : accept(place, folder, timeout);
}

}  // namespace tumblesight::sim

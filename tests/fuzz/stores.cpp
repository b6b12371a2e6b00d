// The files of the flight program's stores with any content: the copies of the persistent store and the model
// image. What is read is the file's, and a store that was written is read again as it was. The first byte
// tells how many bytes the first copy has: all, or as many as follow.
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "hal/posix/file_model_store.hpp"
#include "hal/posix/file_persistent_store.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {
namespace {

namespace posix = hal::posix;

constexpr std::size_t kMostImageBytes = 4096;
constexpr std::array<std::uint8_t, posix::FilePersistentStore::kMagicBytes> kMagic{'T', 'S', 'P', 'S'};

class Folder {
 public:
  Folder() { require(mkdtemp(path_.data()) != nullptr, "a folder can be made"); }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const char* name) const { return path_ + "/" + name; }

 private:
  std::string path_ = "/dev/shm/tumblesight_fuzz_XXXXXX";
};

void put(const std::string& path, const std::string& bytes) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  require(file != nullptr, "a file can be written");
  require(std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size(), "the file takes all bytes");
  std::fclose(file);
}

void check_store(const std::string& path, const std::string& content) {
  posix::FilePersistentStore store;
  require(store.use(path.c_str()), "the path is short enough");
  (void)store.check(kMagic);
  hal::StoredBytes bytes{};
  const hal::StoreStatus status = store.read(0, bytes);
  const bool is_whole = content.size() == bytes.size();
  require((status == hal::StoreStatus::kOk) == is_whole, "a copy is read if it has its size");
  require(!is_whole || std::memcmp(bytes.data(), content.data(), bytes.size()) == 0, "it is read as it is");
  require(store.write(1, bytes) == hal::StoreStatus::kOk, "a copy can be written");
  hal::StoredBytes again{};
  require(store.read(1, again) == hal::StoreStatus::kOk && again == bytes, "it is read as it was written");
}

void check_model(const std::string& path, const std::string& content) {
  posix::FileModelStore store(path.c_str(), kMostImageBytes);
  const bool fits = !content.empty() && content.size() <= kMostImageBytes;
  require((store.status() == posix::FileStatus::kOk) == fits, "an image is read if it fits");
  for (int bank = 0; bank < hal::kModelBanks; ++bank) {
    const hal::ModelBank image = store.bank(bank);
    require(image.size == (fits ? content.size() : 0), "a bank has the image's size");
    require(!fits || std::memcmp(image.data, content.data(), image.size) == 0, "a bank has the image");
  }
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  static const fuzz::Folder folder;
  fuzz::Input input(data, size);
  const bool is_whole = (input.u8() & 1) != 0;
  std::string content = input.text();
  if (is_whole) content.resize(hal::kStoredBytes);
  const std::string path = folder.file("a");
  fuzz::put(path, content);
  fuzz::check_model(path, content);
  fuzz::check_store(path, content);
  return 0;
}

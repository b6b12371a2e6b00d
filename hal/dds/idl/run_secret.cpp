#include "hal/dds/idl/run_secret.hpp"

#include <sys/random.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace tumblesight::hal::dds {
namespace {

bool fill_at_random(void* bytes, std::size_t size) {
  // Requests of up to 256 bytes are not divided. A signal may interrupt the first one after the boot.
  ssize_t got = 0;
  do {
    got = getrandom(bytes, size, 0);
  } while (got < 0 && errno == EINTR);
  return got == static_cast<ssize_t>(size);
}

}  // namespace

bool make_run_secret(RunSecret& secret) {
  struct {
    std::uint32_t run_id;
    unsigned char partition[RunSecret::kPartitionDigits / 2];
  } random;
  if (!fill_at_random(&random, sizeof random)) return false;
  // 0 means "any" and "not ready".
  secret.run_id = random.run_id == 0 ? 1 : random.run_id;
  for (std::size_t i = 0; i < sizeof random.partition; ++i)
    std::snprintf(secret.partition + 2 * i, 3, "%02x", random.partition[i]);
  return true;
}

RunSecretText to_text(const RunSecret& secret) {
  RunSecretText result;
  std::snprintf(result.text, sizeof result.text, "%u:%s", static_cast<unsigned>(secret.run_id),
                secret.partition);
  return result;
}

bool read_run_secret(const char* text, RunSecret& secret) {
  if (text[0] < '0' || text[0] > '9') return false;
  char* end = nullptr;
  errno = 0;
  const unsigned long long run_id = std::strtoull(text, &end, 10);
  if (errno != 0 || run_id > UINT32_MAX || *end != ':') return false;
  const char* const partition = end + 1;
  if (std::strlen(partition) != RunSecret::kPartitionDigits ||
      std::strspn(partition, "0123456789abcdef") != RunSecret::kPartitionDigits)
    return false;
  secret.run_id = static_cast<std::uint32_t>(run_id);
  std::memcpy(secret.partition, partition, RunSecret::kPartitionDigits + 1);
  return true;
}

}  // namespace tumblesight::hal::dds

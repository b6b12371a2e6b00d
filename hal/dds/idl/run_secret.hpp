// RunSecret: what the simulator tells the flight program that it starts, and nobody else: the run id and the
// name of the DDS partition in which both meet. It is passed in the environment, which other users of the
// machine cannot read; a command line is public.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tumblesight::hal::dds {

inline constexpr const char* kRunSecretVariable = "TUMBLESIGHT_SIL_RUN";

struct RunSecret {
  static constexpr std::size_t kPartitionDigits = 32;  // 128 bits

  std::uint32_t run_id = 0;                   // 0: any run
  char partition[kPartitionDigits + 1] = {};  // hexadecimal digits; empty: the default partition
};

struct RunSecretText {
  char text[16 + RunSecret::kPartitionDigits];
};

// Both values from the operating system's random source. False: it has failed.
[[nodiscard]] bool make_run_secret(RunSecret& secret);
// "<run id>:<partition>"
RunSecretText to_text(const RunSecret& secret);
// False: `text` is not of that form; `secret` stays unchanged.
[[nodiscard]] bool read_run_secret(const char* text, RunSecret& secret);

}  // namespace tumblesight::hal::dds

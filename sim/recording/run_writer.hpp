// RunWriter: a run as an MCAP file, whoever writes it: the samples of the bus as they are (CDR, with
// tumblesight.idl as schema), and beside them what viewers show without set-up (foxglove_messages.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hal/dds/idl/topics.hpp"
#include "sim/recording/foxglove_messages.hpp"
#include "sim/recording/mcap_writer.hpp"

namespace tumblesight::sim {

class RunWriter {
 public:
  // Throws std::runtime_error, as all functions do, if the file cannot be written.
  explicit RunWriter(const std::string& path);

  // `time_ns`: not negative (ShownTime).
  void write(const hal::dds::Topic& topic, std::int64_t time_ns, const std::vector<std::uint8_t>& bytes);
  void write(View view, std::int64_t time_ns, std::string_view json);
  // All that viewers show of a step.
  void write(const ShownStep& step, const ShownTime& time);
  // See McapWriter.
  void write_due() { file_.write_due(); }
  void close() { file_.close(); }

 private:
  McapWriter file_;
  std::map<const hal::dds::Topic*, McapId> of_bus_;
  std::array<McapId, kViews.size()> of_views_{};
};

}  // namespace tumblesight::sim

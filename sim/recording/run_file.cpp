#include "sim/recording/run_file.hpp"

#include <algorithm>

#include "hal/dds/idl/icd_hash.hpp"
#include "sim/host/input_file.hpp"

namespace tumblesight::sim {

RunFile::RunFile(const std::string& path) : path_(path), reader_(path) {
  const McapReader::Channel* const steps = reader_.find(hal::dds::topic_of<hal::dds::StepSample>().name);
  if (steps != nullptr && steps->schema_text != hal::dds::idl_text())
    throw std::runtime_error(
        "'" + path +
        "' was recorded with another version of the interface (tumblesight.idl): use the "
        "tumblesight that wrote it");
  if (!reader_.is_whole() && !has_messages())
    throw std::runtime_error("'" + path +
                             "' was cut off before its first part was complete (a second, or a mebibyte): it "
                             "has no message; record the run again");
  (void)channel<hal::dds::StepSample>();  // throws if it is no recording of a run
}

bool RunFile::has_messages() const {
  const auto& channels = reader_.channels();
  return std::any_of(channels.begin(), channels.end(),
                     [&](const auto& channel) { return !reader_.entries(channel.id).empty(); });
}

bool RunFile::is_one(const std::string& path) {
  return begins_with(path, "\x89MCAP");
}

const McapReader::Channel& RunFile::channel_of(const std::string& topic) const {
  const McapReader::Channel* const found = reader_.find(topic);
  if (found == nullptr)
    throw std::runtime_error("'" + path_ + "' has no topic " + topic +
                             ": it is no recording of a run, as tumblesight simulate --mcap FILE writes it");
  return *found;
}

McapReader::Message RunFile::message_of(McapId channel, const McapReader::Entry& entry) const {
  try {
    return reader_.read(channel, entry);
  } catch (const std::runtime_error& error) {
    const std::string what = error.what();
    throw std::runtime_error(what.find(path_) != std::string::npos ? what : "'" + path_ + "': " + what);
  }
}

void RunFile::fail_damaged(const std::string& topic) const {
  throw std::runtime_error("'" + path_ + "': a message of " + topic + " is damaged; record the run again");
}

}  // namespace tumblesight::sim

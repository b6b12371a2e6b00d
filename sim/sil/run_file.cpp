#include "sim/sil/run_file.hpp"

#include <array>
#include <fstream>

#include "hal/dds/idl/icd_hash.hpp"

namespace tumblesight::sim {

RunFile::RunFile(const std::string& path) : path_(path), reader_(path) {
  if (channel<hal::dds::StepSample>().schema_text != hal::dds::idl_text())
    throw std::runtime_error(
        "'" + path +
        "' was recorded with another version of the interface (tumblesight.idl): use the "
        "tumblesight that wrote it");
}

bool RunFile::is_one(const std::string& path) {
  std::array<char, 5> begin{};
  return std::ifstream(path, std::ios::binary).read(begin.data(), begin.size()) &&
         std::string(begin.begin() + 1, begin.end()) == "MCAP";
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

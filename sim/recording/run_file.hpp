// RunFile: reads the samples of a run from an MCAP file that RunRecorder wrote with the same interface
// (tumblesight.idl).
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "sim/recording/cdr_sample.hpp"
#include "sim/recording/mcap_reader.hpp"

namespace tumblesight::sim {

class RunFile {
 public:
  // Throws std::runtime_error that names the file, as all functions do: it is no recording of a run, one of
  // another interface (tumblesight.idl), or damaged.
  explicit RunFile(const std::string& path);

  // Whether the file begins as an MCAP file does.
  static bool is_one(const std::string& path);

  const McapReader& reader() const { return reader_; }
  const std::string& path() const { return path_; }
  template <class Sample>
  const McapReader::Channel& channel() const {
    return channel_of(hal::dds::topic_of<Sample>().name);
  }
  template <class Sample>
  void read(const McapReader::Entry& entry, Sample& sample) const {
    const McapReader::Message message = message_of(channel<Sample>().id, entry);
    if (!read_cdr(message.bytes, message.size, sample)) fail_damaged(channel<Sample>().topic);
  }
  // Calls visit(sample, entry) for every sample of a topic in the order of the file. `sample`: where it is
  // read to, since frames are large.
  template <class Sample, class Visit>
  void each(Sample& sample, const Visit& visit) const {
    for (const McapReader::Entry& entry : reader_.entries(channel<Sample>().id)) {
      read(entry, sample);
      visit(sample, entry);
    }
  }

 private:
  bool has_messages() const;
  const McapReader::Channel& channel_of(const std::string& topic) const;
  McapReader::Message message_of(McapId channel, const McapReader::Entry& entry) const;
  [[noreturn]] void fail_damaged(const std::string& topic) const;

  std::string path_;
  McapReader reader_;
};

}  // namespace tumblesight::sim

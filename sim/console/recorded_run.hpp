// RecordedRun: a run out of an MCAP file that RunRecorder wrote, of this interface.
#pragma once

#include <string>
#include <vector>

#include "sim/console/run_source.hpp"
#include "sim/recording/run_file.hpp"

namespace tumblesight::sim {

class RecordedRun final : public RunSource {
 public:
  // Reads all but the frames. Throws as RunFile does.
  explicit RecordedRun(const std::string& path);

  const StepLog& log() const override { return log_; }
  const char* kind() const override { return "recording"; }
  std::string title() const override { return title_; }
  bool is_whole() const override { return file_.reader().is_whole(); }
  std::uint64_t first_frame() const override { return 0; }
  std::string ask(const std::string& request) const override;
  bool frame(std::uint64_t step, gnc::RangeImage& frame) const override;

 private:
  using Entry = McapReader::Entry;
  struct Place {
    const Entry* entry;
    void (*add)(const RunFile&, const Entry&, StepLog&);
  };
  template <class Sample>
  void list(std::vector<Place>& places) const;
  std::vector<Place> places_in_order() const;

  std::string title_;
  RunFile file_;
  StepLog log_;
};

}  // namespace tumblesight::sim

// BusRun: the run that this user's simulator has on the bus of this machine, as one more participant that
// only reads. It may come late and leave; the run does not wait for it. Before a run begins it waits for one,
// and a later run takes the place of the one before.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hal/dds/idl/domain.hpp"
#include "hal/dds/idl/peer_life.hpp"
#include "hal/dds/idl/topics.hpp"
#include "sim/console/joined_recording.hpp"
#include "sim/console/run_source.hpp"
#include "sim/sil/run_announcement.hpp"

namespace tumblesight::sim {

class BusRun final : public RunSource {
 public:
  static constexpr std::size_t kFramesKept = 512;  // the newest, 17 MB

  // `domain`: -1: any. `security_path`: file of hal/dds/make_security, empty: the bus is not secured. Throws
  // SilFailure if the file cannot be read.
  // `mcap_path`: of a recording of the run; empty: none.
  BusRun(int domain, const std::string& security_path, const std::string& mcap_path = {});
  ~BusRun() override;

  const StepLog& log() const override { return log_; }
  const char* kind() const override { return "bus"; }
  std::string title() const override;
  std::uint64_t first_frame() const override;
  std::string ask(const std::string& request) const override;
  // Why the bus could not be joined, or the recording not be written; empty: it could.
  std::string failure() const;
  bool frame(std::uint64_t step, gnc::RangeImage& frame) const override;

 private:
  struct KeptFrame {
    std::uint32_t k;
    gnc::RangeImage frame;
  };
  // Of one run.
  struct Connection {
    hal::dds::RunSecret secret;
    hal::dds::Domain domain;
    hal::dds::PeerLife simulator_life;
    dds_entity_t participant = 0, waitset = 0;
    std::vector<std::pair<const hal::dds::Topic*, dds_entity_t>> readers;
    void watch_life(const hal::dds::HelloSample& hello);
  };
  std::unique_ptr<Connection> connect(const AnnouncedRun& run) const;
  template <class Sample>
  static void open(Connection& connection);
  template <class Sample>
  bool take(Connection& connection, Sample& sample);
  template <class Sample>
  void show(const Sample& sample);
  bool take_samples(Connection& connection);
  void keep(const hal::dds::LidarFrameSample& sample);
  void follow(Connection& connection, std::uint32_t domain);
  std::optional<AnnouncedRun> newest_run();
  bool is_newest(std::uint32_t run_id);
  void join(std::optional<std::uint32_t> domain);
  template <class Action>
  void record(const Action& action);
  void note(const std::string& failure);
  void begin_recording();
  void end_recording();
  void look_for_runs();

  StepLog log_;
  int domain_;
  std::string mcap_path_;                       // of a recording that is to begin
  std::uint32_t followed_run_ = 0;              // of the thread: the run that it has joined
  std::unique_ptr<JoinedRecording> recording_;  // of the thread
  std::unique_ptr<hal::dds::SecurityElement> security_;
  std::unique_ptr<hal::dds::LidarFrameSample> frame_sample_;
  mutable std::mutex mutex_;  // of what follows
  std::string failure_;       // why the last run could not be joined
  std::deque<KeptFrame> frames_;
  std::uint32_t run_of_frames_ = 0;
  std::optional<std::uint32_t> joined_;  // the domain of the run
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;  // last: ends before what it uses
};

}  // namespace tumblesight::sim

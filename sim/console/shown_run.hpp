// ShownRun: what a viewer is shown of a run that may go on, view by view, each from where it has come to. A
// client on the network and a file are such viewers.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sim/console/run_source.hpp"
#include "sim/recording/foxglove_messages.hpp"

namespace tumblesight::sim {

class ShownRun {
 public:
  static constexpr std::uint64_t kStepsPerPoll = 64;  // what a slow viewer has missed comes in parts

  struct Message {
    std::uint32_t id;  // of what was followed
    std::int64_t time_ns;
    std::string text;
    bool is_failure;  // the text says why there is no message
  };

  // `run` must outlive the object. Calls must not overlap.
  explicit ShownRun(const RunSource& run) : run_(run) {}

  // Takes the run as it is now for the one that is shown.
  void begin();
  std::uint32_t run_id() const { return run_id_; }
  // From the newest step on. `id`: of none that is followed.
  void follow(std::uint32_t id, View view);
  // False: it is none that is followed.
  bool forget(std::uint32_t id) { return followed_.erase(id) != 0; }
  // Null: it is none that is followed.
  const View* find(std::uint32_t id) const;
  // The id by which a view is followed; null: it is not.
  const std::uint32_t* find(View view) const;
  // What is new since the last call. Of another run (run_id()) it is everything. Point clouds are large: who
  // has missed some gets the newest one alone.
  std::vector<Message> poll();

 private:
  struct Followed {
    View view;
    std::uint64_t next;  // step to show
  };

  void add_step(std::uint64_t number, bool is_newest, std::vector<Message>& out);
  // True: there is no more of this step.
  bool add_points(std::uint64_t number, std::int64_t time_ns, std::uint32_t id, std::vector<Message>& out);
  void add_messages(const LoggedStep& logged, std::uint64_t number, std::uint32_t id, View view,
                    std::vector<Message>& out);
  void add(const ShownStep& step, std::uint32_t id, View view, std::vector<Message>& out) const;

  const RunSource& run_;
  std::uint32_t run_id_ = 0;
  ShownTime time_;  // from the first step of the run, or from the first that is shown
  std::map<std::uint32_t, Followed> followed_;
};

}  // namespace tumblesight::sim

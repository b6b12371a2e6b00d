// FakeLink: scripted telecommands in; keeps all telemetry for the test to look at. Host only.
#pragma once

#include <deque>
#include <vector>

#include "hal/link.hpp"

namespace tumblesight::hal::fake {

class FakeLink final : public Link {
 public:
  void add(const CommandPacket& command) { commands_.push_back(command); }
  std::size_t waiting() const { return commands_.size(); }

  bool receive(CommandPacket& command) override {
    if (commands_.empty()) return false;
    command = commands_.front();
    commands_.pop_front();
    return true;
  }
  void publish(const AttitudeReport& report) override { attitudes.push_back(report); }
  void publish(const Telemetry& sample) override { telemetry.push_back(sample); }
  void publish(const Event& event) override { events.push_back(event); }
  void publish(const MemoryDump& dump) override { dumps.push_back(dump); }

  std::vector<AttitudeReport> attitudes;
  std::vector<Telemetry> telemetry;
  std::vector<Event> events;
  std::vector<MemoryDump> dumps;

 private:
  std::deque<CommandPacket> commands_;
};

}  // namespace tumblesight::hal::fake

// The answers of the console to the requests of its page (docs/console.md, section API), without the network.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "sim/console/console_target.hpp"
#include "sim/console/run_source.hpp"

namespace tumblesight::sim {

struct Answer {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::string allow;  // methods, with status 405
};

// What a request says of itself. Empty: it does not.
struct Request {
  std::string method, path, query, host, origin, body;
};

class Requests {
 public:
  static constexpr std::size_t kMostBody = 16'384;  // bytes
  // The model image of a target by its name; empty: it is not known.
  using ModelOf = std::function<std::string(const std::string& target)>;

  // `run` must outlive the object. `token`: that every request for data has to give.
  Requests(const RunSource& run, ModelOf model_of, std::string token);

  // For any thread. `port`: at which the request came in.
  Answer answer(const Request& request, int port) const;
  // Why a request is not answered; empty: it is. Only the page itself may ask: not another page in the same
  // browser, not a name of another host that leads here, and nobody without the address that was printed.
  std::string refusal_of(const Request& request, int port) const;
  // The same of a client of the Foxglove WebSocket protocol. Those in a browser have an origin of their own,
  // so that the token alone tells whom the user has let in.
  std::string refusal_of_foxglove(const Request& request, int port) const;
  // Whether the body of a request matters to its answer.
  bool takes_body_of(const Request& request, int port) const;
  const RunSource& run() const { return run_; }
  // What the page is told whenever it changes.
  std::string state_text() const;

 private:
  Answer get_answer(const Request& request) const;
  Answer run_answer() const;
  Answer step_answer(std::uint64_t step) const;
  Answer frame_answer(std::uint64_t step) const;
  Answer depth_answer(std::uint64_t step) const;
  Answer mesh_answer() const;
  // Of requests that change the run.
  Answer post_answer(const Request& request) const;
  Answer run_answer_to(const Json& request) const;
  Answer command_answer(const Json& wanted) const;
  Answer fault_answer(const Json& wanted) const;
  // Null: the target or its image is not known.
  std::shared_ptr<const ConsoleTarget> target() const;

  const RunSource& run_;
  ModelOf model_of_;
  std::string token_;
  mutable std::mutex mutex_;  // of the target
  mutable std::string target_name_;
  mutable std::shared_ptr<const ConsoleTarget> target_;
};

// The value of a name in a query, "" without one.
std::string query_value(const std::string& query, const std::string& name);

}  // namespace tumblesight::sim

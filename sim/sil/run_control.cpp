#include "sim/sil/run_control.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "hal/messages/command_packet.hpp"
#include "sim/json/json_text.hpp"
#include "sim/sil/failure.hpp"
#include "sim/sil/runtime_folder.hpp"
#include "sim/sil/telecommand_table.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::json;

constexpr int kMostWaiting = 8;  // connections
constexpr std::size_t kMostDepth = 4;
constexpr const char* kNotAnswered =
    "the run has not taken the request in time, and will not carry it out: it is paused, or its steps take "
    "longer than that";

std::string name_of(std::uint32_t domain) {
  return "domain-" + std::to_string(domain) + ".control";
}

// Empty: the user has no folder for it.
std::string path_of(std::uint32_t domain) {
  try {
    return RuntimeFolder().path_of(name_of(domain));
  } catch (const SilFailure&) {
    return {};
  }
}

// False: the path is too long for a socket.
bool address_of(const std::string& path, sockaddr_un& address) {
  address = {};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) return false;
  std::memcpy(address.sun_path, path.data(), path.size());
  return true;
}

bool is_own_user(int socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  return getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.uid == geteuid();
}

// False: the run has ended.
bool is_listening(const sockaddr_un& address) {
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket < 0) return false;
  const bool is_taken = connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ||
                        errno == EAGAIN;  // as many wait as can
  close(socket);
  return is_taken;
}

// One that does not fit is beyond every limit here.
std::int64_t whole_number(const Json& value) {
  if (!value.is_number_integer()) throw std::invalid_argument("steps and function must be whole numbers");
  if (value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX) return INT64_MAX;
  return value.get<std::int64_t>();
}

InjectedFault fault_of(const Json& request) {
  InjectedFault fault;
  fault.name = request.at("fault").get<std::string>();
  const std::int64_t steps = whole_number(request.at("steps"));
  fault.steps = static_cast<std::uint32_t>(std::clamp<std::int64_t>(steps, 0, UINT32_MAX));
  if (request.contains("strength")) {
    if (!request.at("strength").is_number()) throw std::invalid_argument("the strength must be a number");
    fault.strength = request.at("strength").get<double>();
  }
  require_possible(fault);
  return fault;
}

Telecommand telecommand_of(const Json& request) {
  const std::int64_t function = whole_number(request.at("function"));
  if (function < 0 || function > 127) throw std::invalid_argument("a function code is 0 to 127");
  const std::vector<std::uint8_t> arguments = bytes_of_hex(request.at("arguments").get<std::string>());
  if (arguments.size() > hal::kMaxCommandArgumentBytes)
    throw std::invalid_argument("a telecommand has at most " + std::to_string(hal::kMaxCommandArgumentBytes) +
                                " bytes of arguments");
  return {static_cast<hal::FunctionCode>(function), arguments};
}

}  // namespace

RunControl::RunControl(std::uint32_t domain) : path_(path_of(domain)) {
  sockaddr_un address;
  if (!address_of(path_, address)) return;
  socket_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  unlink(path_.c_str());  // of a run that was killed
  // Nobody can connect before listen(). umask() would also change that of the other threads.
  const bool is_bound =
      socket_ >= 0 && bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (is_bound && chmod(path_.c_str(), 0600) == 0 && listen(socket_, kMostWaiting) == 0) return;
  if (socket_ >= 0) close(socket_);
  socket_ = -1;
}

RunControl::~RunControl() {
  for (const Client& client : clients_) close(client.socket);
  if (socket_ < 0) return;
  close(socket_);
  unlink(path_.c_str());
}

void RunControl::accept_clients() {
  while (clients_.size() < kMostClients) {
    const int socket = accept4(socket_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (socket < 0) return;
    if (is_own_user(socket))
      clients_.push_back({socket, {}});
    else
      close(socket);
  }
}

RunRequests RunControl::take(std::uint32_t step, FrameFaults& frames, StepSource& source) {
  Step of{step, frames, source, {}};
  if (socket_ < 0) return of.requests;
  accept_clients();
  clients_.erase(std::remove_if(clients_.begin(), clients_.end(),
                                [&](Client& client) {
                                  if (serve(client, of)) return false;
                                  close(client.socket);
                                  return true;
                                }),
                 clients_.end());
  return of.requests;
}

// Throws std::invalid_argument or a JSON exception.
void RunControl::take_request(const std::string& line, Step& step) {
  const Json request = parse_json(line, {kMostDepth});
  if (request.contains("fault")) {
    const InjectedFault fault = fault_of(request);
    if (step.requests.faults.size() >= kMostFaults)
      throw std::invalid_argument("a step takes at most " + std::to_string(kMostFaults) +
                                  " faults: send it again");
    FrameFaults::Kind kind{};
    if (read_fault(fault.name, kind))
      step.frames.begin(kind, fault.steps);
    else
      step.source.begin_fault(fault);
    step.requests.faults.push_back(fault);
    return;
  }
  if (!step.source.takes_telecommands())
    throw std::invalid_argument(
        "the telecommands of this run are recorded, with their numbers: start a run with tumblesight "
        "simulate");
  if (step.requests.commands.size() >= kMostCommands)
    throw std::invalid_argument("a step takes at most " + std::to_string(kMostCommands) +
                                " telecommands: send it again");
  step.requests.commands.push_back(telecommand_of(request));
}

std::string RunControl::answer_to(const std::string& line, Step& step) {
  try {
    take_request(line, step);
    return Json{{"step", step.k}}.dump() + "\n";
  } catch (const std::invalid_argument& error) {
    return Json{{"error", error.what()}}.dump() + "\n";
  } catch (const Json::exception&) {
    return Json{{"error", "the request is not as RunControl knows it"}}.dump() + "\n";
  }
}

// False: the client has left, or must leave.
bool RunControl::serve(Client& client, Step& step) {
  // Who has given up waiting has told its user so, and nothing of it must be carried out afterwards.
  pollfd state{client.socket, POLLIN | POLLRDHUP, 0};
  if (poll(&state, 1, 0) > 0 && (state.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0) return false;
  char buffer[kMostBytes];
  const ssize_t count = read(client.socket, buffer, sizeof buffer);
  if (count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK)) return false;
  if (count > 0) client.received.append(buffer, static_cast<std::size_t>(count));
  for (std::size_t end = client.received.find('\n'); end != std::string::npos;
       end = client.received.find('\n')) {
    const std::string answer = answer_to(client.received.substr(0, end), step);
    client.received.erase(0, end + 1);
    // One that does not read its answers is not waited for.
    if (send(client.socket, answer.data(), answer.size(), MSG_NOSIGNAL | MSG_DONTWAIT) !=
        static_cast<ssize_t>(answer.size()))
      return false;
  }
  return client.received.size() < kMostBytes;
}

std::string ask_run(std::uint32_t domain, const std::string& request, int timeout_ms) {
  if (request.size() >= RunControl::kMostBytes)
    throw std::invalid_argument("the request has " + std::to_string(request.size()) +
                                " bytes; a run takes at most " + std::to_string(RunControl::kMostBytes - 1));
  sockaddr_un address;
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  struct Closer {
    int socket;
    ~Closer() {
      if (socket >= 0) close(socket);
    }
  } closer{socket};
  const std::string path = RuntimeFolder().path_of(name_of(domain));
  if (socket < 0 || !address_of(path, address))
    throw SilFailure("the run takes no requests: it has ended, or is of another version");
  const int connected = connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  if (connected != 0 && errno == EAGAIN) throw SilFailure(kNotAnswered);  // too many wait before
  if (connected != 0 || !is_own_user(socket))
    throw SilFailure("the run takes no requests: it has ended, or is of another version");
  const std::string line = request + "\n";
  if (send(socket, line.data(), line.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(line.size()))
    throw SilFailure("the run did not take the request");
  std::string answer;
  pollfd readable{socket, POLLIN, 0};
  while (answer.find('\n') == std::string::npos) {
    char buffer[1024];
    if (poll(&readable, 1, timeout_ms) <= 0) throw SilFailure(kNotAnswered);
    const ssize_t count = read(socket, buffer, sizeof buffer);
    if (count <= 0)
      throw SilFailure(is_listening(address)
                           ? "the run closed the connection without an answer: send it again"
                           : "the run ended before it answered");
    answer.append(buffer, static_cast<std::size_t>(count));
  }
  answer.pop_back();
  return answer;
}

}  // namespace tumblesight::sim

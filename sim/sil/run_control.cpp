#include "sim/sil/run_control.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>
#include <utility>

#include "sim/operations/request_line.hpp"
#include "sim/sil/runtime_folder.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::json;

constexpr int kMostWaiting = 8;  // connections
constexpr const char* kNotAnswered =
    "the run has not taken the request in time, and will not carry it out: it is paused, or its steps take "
    "longer than that";

std::string name_of(std::uint32_t domain) {
  return "domain-" + std::to_string(domain) + ".control";
}

// By the descriptor of the folder where the path is too long for a socket. `folder` must stay open.
sockaddr_un address_of(const RuntimeFolder& folder, const std::string& name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::string path = folder.path_of(name);
  if (path.size() >= sizeof address.sun_path)
    path = "/proc/self/fd/" + std::to_string(folder.descriptor()) + "/" + name;
  std::memcpy(address.sun_path, path.data(), path.size());
  return address;
}

// A socket that is closed with the object.
class Socket {
 public:
  Socket() : socket_(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {}
  ~Socket() {
    if (socket_ >= 0) close(socket_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  operator int() const { return socket_; }
  int release() { return std::exchange(socket_, -1); }

 private:
  int socket_;
};

bool is_own_user(int socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  return getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.uid == geteuid();
}

// 0, or an errno.
int connect_to(const sockaddr_un& address, int socket) {
  return connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? 0 : errno;
}

// False: the run has ended.
bool is_listening(const sockaddr_un& address) {
  const Socket socket;
  const int error = connect_to(address, socket);
  return error == 0 || error == EAGAIN;  // as many wait as can
}

// Why nothing can be asked at a path, with the remedy.
std::string reason_of(const std::string& path, int error) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0)
    return "there is no such socket: the run has ended, is of another version, or could not make the socket "
           "and said so at its start";
  if (!S_ISSOCK(status.st_mode)) return "this is no socket: remove it, and start the run again";
  if (error == ECONNREFUSED) return "nobody listens: the run has ended";
  return strerror(error);
}

int remaining_ms(std::chrono::steady_clock::time_point end) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
  return static_cast<int>(std::max<std::int64_t>(0, left.count()));
}

// A run takes some connections in a step, and as many wait: the others try again.
void connect_in_time(const sockaddr_un& address, int socket, const std::string& path,
                     std::chrono::steady_clock::time_point end) {
  constexpr auto kBetweenTries = std::chrono::milliseconds(10);
  int error = connect_to(address, socket);
  for (; error == EAGAIN; error = connect_to(address, socket)) {
    if (remaining_ms(end) == 0)
      throw RunIsBusy("too many requests wait for the run, and this one was not sent: send it again");
    std::this_thread::sleep_for(kBetweenTries);
  }
  if (error != 0) throw SilFailure("the run takes no requests at " + path + ": " + reason_of(path, error));
  if (!is_own_user(socket))
    throw SilFailure("the run takes no requests at " + path + ": another user listens there");
}

}  // namespace

RunControl::RunControl(std::uint32_t domain) {
  try {
    const RuntimeFolder folder;
    path_ = folder.path_of(name_of(domain));
    listen_in(folder, name_of(domain));
  } catch (const SilFailure& failure) {
    failure_ = std::string("this run takes no telecommands and faults from the console: ") + failure.what();
  }
}

void RunControl::listen_in(const RuntimeFolder& folder, const std::string& name) {
  const sockaddr_un address = address_of(folder, name);
  Socket socket;
  unlinkat(folder.descriptor(), name.c_str(), 0);  // of a run that was killed
  // Nobody can connect before listen(). umask() would also change that of the other threads.
  if (socket >= 0 && bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      chmod(path_.c_str(), 0600) == 0 && listen(socket, kMostWaiting) == 0) {
    socket_ = socket.release();
    return;
  }
  const int error = errno;
  throw SilFailure("the socket " + path_ + " cannot be made: " + strerror(error) +
                   (error == EADDRINUSE ? "; remove what has its name, and start the run again" : ""));
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

// Throws std::invalid_argument.
void RunControl::take_request(const std::string& line, Step& step) {
  RequestLine request = read_request_line(line);
  if (request.fault) return take_fault(*request.fault, step);
  if (!step.source.takes_telecommands())
    throw std::invalid_argument(
        "the telecommands of this run are recorded, with their numbers: start a run with tumblesight "
        "simulate");
  if (step.requests.commands.size() >= kMostCommands)
    throw std::invalid_argument("a step takes at most " + std::to_string(kMostCommands) +
                                " telecommands: send it again");
  step.requests.commands.push_back(std::move(request.command));
}

void RunControl::take_fault(const InjectedFault& fault, Step& step) {
  if (step.requests.faults.size() >= kMostFaults)
    throw std::invalid_argument("a step takes at most " + std::to_string(kMostFaults) +
                                " faults: send it again");
  FrameFaults::Kind kind{};
  if (read_fault(fault.name, kind))
    step.frames.begin(kind, fault.steps);
  else
    step.source.begin_fault(fault);
  step.requests.faults.push_back(fault);
}

std::string RunControl::answer_to(const std::string& line, Step& step) {
  try {
    take_request(line, step);
    return Json{{"step", step.k}}.dump() + "\n";
  } catch (const std::invalid_argument& error) {
    return Json{{"error", error.what()}}.dump() + "\n";
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
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(timeout_ms);
  const RuntimeFolder folder;
  const sockaddr_un address = address_of(folder, name_of(domain));
  const Socket socket;
  connect_in_time(address, socket, folder.path_of(name_of(domain)), end);
  const std::string line = request + "\n";
  if (send(socket, line.data(), line.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(line.size()))
    throw SilFailure("the run did not take the request");
  std::string answer;
  pollfd readable{socket, POLLIN, 0};
  while (answer.find('\n') == std::string::npos) {
    char buffer[1024];
    if (poll(&readable, 1, remaining_ms(end)) <= 0) throw SilFailure(kNotAnswered);
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

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
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>

#include "hal/messages/command_packet.hpp"
#include "sim/sil/failure.hpp"
#include "sim/sil/telecommand_table.hpp"

namespace tumblesight::sim {
namespace {

using Json = nlohmann::json;

constexpr int kMostWaiting = 8;  // connections

std::string path_of(std::uint32_t domain) {
  std::error_code no_folder;
  const std::string folder = std::filesystem::temp_directory_path(no_folder);
  if (no_folder) return {};
  return folder + "/tumblesight-domain-" + std::to_string(domain) + ".control";
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

// Throws std::invalid_argument or a JSON exception.
void take_request(const std::string& line, FrameFaults& faults, std::vector<Telecommand>& commands) {
  const Json request = Json::parse(line);
  if (request.contains("fault")) {
    FrameFaults::Kind kind{};
    const auto steps = request.at("steps").get<std::int64_t>();
    if (!read_fault(request.at("fault").get<std::string>(), kind))
      throw std::invalid_argument("there is no fault '" + request.at("fault").get<std::string>() +
                                  "': drop, freeze or delay");
    if (steps < 1 || steps > FrameFaults::kMostSteps)
      throw std::invalid_argument("steps must be 1 to " + std::to_string(FrameFaults::kMostSteps));
    faults.begin(kind, static_cast<std::uint32_t>(steps));
    return;
  }
  const auto function = request.at("function").get<std::int64_t>();
  if (function < 0 || function > 127) throw std::invalid_argument("a function code is 0 to 127");
  const std::vector<std::uint8_t> arguments = bytes_of_hex(request.at("arguments").get<std::string>());
  if (arguments.size() > hal::kMaxCommandArgumentBytes)
    throw std::invalid_argument("a telecommand has at most " + std::to_string(hal::kMaxCommandArgumentBytes) +
                                " bytes of arguments");
  if (commands.size() >= RunControl::kMostCommands)
    throw std::invalid_argument("a step takes at most " + std::to_string(RunControl::kMostCommands) +
                                " telecommands: send it again");
  commands.push_back({static_cast<hal::FunctionCode>(function), arguments});
}

std::string answer_to(const std::string& line, std::uint32_t step, FrameFaults& faults,
                      std::vector<Telecommand>& commands) {
  try {
    take_request(line, faults, commands);
    return Json{{"step", step}}.dump() + "\n";
  } catch (const std::invalid_argument& error) {
    return Json{{"error", error.what()}}.dump() + "\n";
  } catch (const Json::exception&) {
    return Json{{"error", "the request is not as RunControl knows it"}}.dump() + "\n";
  }
}

}  // namespace

RunControl::RunControl(std::uint32_t domain) : path_(path_of(domain)) {
  sockaddr_un address;
  if (!address_of(path_, address)) return;
  socket_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  unlink(path_.c_str());  // of a run that was killed
  const mode_t before = umask(0177);
  const bool is_bound =
      socket_ >= 0 && bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  umask(before);
  if (is_bound && listen(socket_, kMostWaiting) == 0) return;
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

std::vector<Telecommand> RunControl::take(std::uint32_t step, FrameFaults& faults) {
  std::vector<Telecommand> commands;
  if (socket_ < 0) return commands;
  accept_clients();
  clients_.erase(std::remove_if(clients_.begin(), clients_.end(),
                                [&](Client& client) {
                                  if (serve(client, step, faults, commands)) return false;
                                  close(client.socket);
                                  return true;
                                }),
                 clients_.end());
  return commands;
}

// False: the client has left, or must leave.
bool RunControl::serve(Client& client, std::uint32_t step, FrameFaults& faults,
                       std::vector<Telecommand>& commands) {
  char buffer[kMostBytes];
  const ssize_t count = read(client.socket, buffer, sizeof buffer);
  if (count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK)) return false;
  if (count > 0) client.received.append(buffer, static_cast<std::size_t>(count));
  for (std::size_t end = client.received.find('\n'); end != std::string::npos;
       end = client.received.find('\n')) {
    const std::string answer = answer_to(client.received.substr(0, end), step, faults, commands);
    client.received.erase(0, end + 1);
    // One that does not read its answers is not waited for.
    if (send(client.socket, answer.data(), answer.size(), MSG_NOSIGNAL | MSG_DONTWAIT) !=
        static_cast<ssize_t>(answer.size()))
      return false;
  }
  return client.received.size() < kMostBytes;
}

std::string ask_run(std::uint32_t domain, const std::string& request, int timeout_ms) {
  sockaddr_un address;
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  struct Closer {
    int socket;
    ~Closer() {
      if (socket >= 0) close(socket);
    }
  } closer{socket};
  if (socket < 0 || !address_of(path_of(domain), address) ||
      connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      !is_own_user(socket))
    throw SilFailure("the run takes no requests: it has ended, or is of another version");
  const std::string line = request + "\n";
  if (send(socket, line.data(), line.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(line.size()))
    throw SilFailure("the run did not take the request");
  std::string answer;
  pollfd readable{socket, POLLIN, 0};
  while (answer.find('\n') == std::string::npos) {
    char buffer[1024];
    if (poll(&readable, 1, timeout_ms) <= 0) throw SilFailure("the run has not answered: is it paused?");
    const ssize_t count = read(socket, buffer, sizeof buffer);
    if (count <= 0) throw SilFailure("the run ended before it answered");
    answer.append(buffer, static_cast<std::size_t>(count));
  }
  answer.pop_back();
  return answer;
}

}  // namespace tumblesight::sim

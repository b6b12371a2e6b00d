// What may stand where a program expects an input file: a folder, a pipe that nobody writes, a device without
// end, nothing, a file of 3 GB, a file without permission.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace tumblesight {

struct HostileFile {
  std::string kind;
  std::string path;
};

// Their names have the ending of the file that is expected: ".tslr".
class HostileFiles {
 public:
  explicit HostileFiles(const std::string& ending) {
    std::filesystem::create_directory(add("folder", ending));
    (void)mkfifo(add("pipe", ending).c_str(), 0600);
    std::filesystem::create_symlink("/dev/zero", add("device", ending));
    std::ofstream(add("empty", ending)).flush();
    std::ofstream(add("huge", ending)).flush();
    std::filesystem::resize_file(files_.back().path, kHugeBytes);  // takes no space on the disk
    add_socket(add("socket", ending));
    if (geteuid() != 0) {  // root may read all
      std::ofstream(add("unreadable", ending)) << "x";
      (void)chmod(files_.back().path.c_str(), 0);
    }
  }
  const std::vector<HostileFile>& files() const { return files_; }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  static constexpr std::uintmax_t kHugeBytes = 3ULL << 30;

  const std::string& add(const std::string& kind, const std::string& ending) {
    files_.push_back({kind, folder_.path(kind + ending)});
    return files_.back().path;
  }
  static void add_socket(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    const int file = socket(AF_UNIX, SOCK_STREAM, 0);
    EXPECT_EQ(bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    close(file);
  }

  TemporaryFolder folder_;
  std::vector<HostileFile> files_;
};

// What a process of its own did with a file, and what that took.
struct Outcome {
  std::string message;  // of the exception; empty: it was accepted
  int signal = 0;       // that ended it: SIGALRM if it took too long
  long peak_kib = 0;    // of its memory
};

// `door` reads the file, and throws if it refuses it.
inline Outcome outcome_of(const std::function<void()>& door) {
  constexpr unsigned kMost_s = 20;  // far more than any refusal needs
  int ends[2];
  if (pipe(ends) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGALRM, SIG_DFL);
    alarm(kMost_s);
    std::string message;
    try {
      door();
    } catch (const std::exception& error) {
      message = error.what();
    }
    const ssize_t written = write(ends[1], message.data(), message.size());
    _exit(written == static_cast<ssize_t>(message.size()) ? 0 : 1);
  }
  close(ends[1]);
  Outcome outcome;
  char block[512];
  for (ssize_t count = 0; (count = read(ends[0], block, sizeof block)) > 0;)
    outcome.message.append(block, static_cast<std::size_t>(count));
  close(ends[0]);
  int status = 0;
  rusage usage{};
  (void)wait4(child, &status, 0, &usage);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  outcome.peak_kib = usage.ru_maxrss;
  return outcome;
}

inline long own_peak_kib() {
  rusage usage{};
  (void)getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// Refused with its name in bounded time and memory, whatever stands in the file's place.
inline void expect_all_refused(const std::string& ending,
                               const std::function<void(const std::string& path)>& door) {
  constexpr long kMost_kib = 300L * 1024;  // more than a process has without the file
  constexpr std::size_t kMostOfAMessage = 1000;
  const HostileFiles hostile(ending);
  for (const HostileFile& file : hostile.files()) {
    const Outcome outcome = outcome_of([&] { door(file.path); });
    EXPECT_EQ(outcome.signal, 0) << file.kind;
    EXPECT_NE(outcome.message.find(file.path), std::string::npos) << file.kind << ": " << outcome.message;
    EXPECT_LT(outcome.message.size(), kMostOfAMessage) << file.kind;
    EXPECT_LT(outcome.peak_kib, own_peak_kib() + kMost_kib) << file.kind;
  }
}

}  // namespace tumblesight

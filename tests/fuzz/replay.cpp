// Runs a fuzz target once on every input of its corpus, without libFuzzer. Every ordinary build does this as
// a test, so that a defect which fuzzing has found cannot come back.
//   replay_<target> PATH...    each an archive of inputs (*.inputs) or a single input
// The format of an archive: tests/fuzz/corpus.py.
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "%s: cannot be read\n", path.c_str());
    std::exit(2);
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

void run(const std::string& name, const std::string& input) {
  std::printf("%s\n", name.c_str());  // the last name in the output is that of the input which failed
  std::fflush(stdout);
  // A copy of exactly the input's size, so that a sanitizer sees every byte read beyond it.
  const std::vector<std::uint8_t> bytes(input.begin(), input.end());
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
}

[[noreturn]] void refuse_archive(const fs::path& path, std::size_t at) {
  std::fprintf(stderr, "%s: byte %zu: expected 'SIZE NAME', the input's bytes and a line feed\n",
               path.c_str(), at);
  std::exit(2);
}

int run_archive(const fs::path& path) {
  const std::string archive = content_of(path);
  int count = 0;
  for (std::size_t at = 0; at < archive.size(); ++count) {
    const std::size_t space = archive.find(' ', at);
    const std::size_t line_end = archive.find('\n', at);
    if (line_end == std::string::npos || space >= line_end || space == at || space - at > 9) {
      refuse_archive(path, at);
    }
    const std::string size_text = archive.substr(at, space - at);
    if (!std::all_of(size_text.begin(), size_text.end(), [](unsigned char c) { return std::isdigit(c); })) {
      refuse_archive(path, at);
    }
    const std::size_t size = std::stoul(size_text);
    const std::size_t end = line_end + 1 + size;
    if (end >= archive.size() || archive[end] != '\n') refuse_archive(path, at);
    run(archive.substr(space + 1, line_end - space - 1), archive.substr(line_end + 1, size));
    at = end + 1;
  }
  return count;
}

int run_path(const fs::path& path) {
  if (path.extension() == ".inputs") return run_archive(path);
  run(path.string(), content_of(path));
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s PATH...\n", argv[0]);
    return 2;
  }
  LLVMFuzzerTestOneInput(nullptr, 0);
  for (int i = 1; i < argc; ++i) {
    if (run_path(argv[i]) == 0) {
      std::fprintf(stderr, "%s: no inputs\n", argv[i]);
      return 1;
    }
  }
  return 0;
}

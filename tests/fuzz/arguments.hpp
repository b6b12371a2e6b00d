// Command lines made from inputs: one argument per line.
#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {

// As main() receives it: NUL-terminated words, the first one is the program.
class CommandLine {
 public:
  explicit CommandLine(Input input) {
    constexpr std::size_t kMost = 64;
    words_ = {"program", ""};
    for (const char c : input.text()) {
      if (c != '\n') {
        words_.back() += c;
      } else if (words_.size() < kMost) {
        words_.emplace_back();
      }
    }
    for (std::string& word : words_) word.resize(std::min(word.size(), word.find('\0')));
    for (std::string& word : words_) pointers_.push_back(word.data());
    pointers_.push_back(nullptr);
  }
  int argc() const { return static_cast<int>(words_.size()); }
  char** argv() { return pointers_.data(); }

 private:
  std::vector<std::string> words_;
  std::vector<char*> pointers_;
};

// A parser for many command lines. Constructing one takes longer than using it, but its memory grows with
// each use, so it is replaced after kMostUses uses.
class Reused {
 public:
  explicit Reused(std::function<std::unique_ptr<CLI::App>()> make) : make_(std::move(make)) {}
  CLI::App& get() {
    constexpr int kMostUses = 4096;
    if (uses_++ % kMostUses == 0) app_ = make_();
    return *app_;
  }

 private:
  std::function<std::unique_ptr<CLI::App>()> make_;
  std::unique_ptr<CLI::App> app_;
  int uses_ = 0;
};

}  // namespace tumblesight::fuzz

// Command lines out of inputs: an argument a line.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {

// As main() gets it: NUL-terminated words, of which the first is the program.
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

}  // namespace tumblesight::fuzz

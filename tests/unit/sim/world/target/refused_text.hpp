// What a reader says of content that it refuses.
#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace tumblesight::sim {

// `read` must throw std::runtime_error whose text is one line, short, and holds each of `parts`.
template <class Read>
void expect_refusal(const Read& read, const std::vector<std::string>& parts) {
  try {
    read();
    ADD_FAILURE() << "not refused: " << parts.front();
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    EXPECT_LT(text.size(), 400U) << text;
    for (const char c : text) EXPECT_GE(static_cast<unsigned char>(c), 0x20U) << text;
    for (const std::string& part : parts)
      EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
  }
}

}  // namespace tumblesight::sim

// Text for a terminal and for reports.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tumblesight::sim {

// Text in columns: its width, and its division into lines. Text is UTF-8; every code point counts as one
// column.
std::size_t columns_of(const std::string& text);

// Breaks lines at spaces, so that none has more columns unless one word does.
std::string wrapped(const std::string& text, std::size_t columns);

// A value of the user's own in a message: at most `most` bytes of it, then "...", with a "?" for every
// control character and every byte that is not UTF-8, so that one damaged file cannot fill or upset a
// terminal.
inline constexpr std::size_t kMostOfAValue = 60;
std::string shortened(const std::string& text, std::size_t most = kMostOfAValue);

// A word of a command line as a shell takes it: in quotes if it needs them.
std::string shell_word(const std::string& word);
// The words of a line as a POSIX shell divides it: at spaces outside of quotes. Nothing is expanded.
std::vector<std::string> shell_words(const std::string& line);

// A number with its noun.
// "1 frame", "2 frames".
inline std::string counted(std::uint64_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

// A line on standard error. One that cannot be shown, as on a full disk, is no failure.
void print_message(const std::string& line);
void print_note(const std::string& text);  // "  note: ..."
// Whether a text is UTF-8.
bool is_utf8(const std::string& text);

// The time of day, for reports.
// Now, in the local time zone: "2026-03-14 09:26 CET".
std::string local_time_text();

}  // namespace tumblesight::sim

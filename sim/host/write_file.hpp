// Writing of files as a whole: reports, tables, figures, recordings.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tumblesight::sim {

// Replaces the file as a whole: a reader never finds a part of it, and a failure leaves the old file. A path
// that is neither missing nor a plain file, such as /dev/stdout or a link, is written to directly. Creates
// missing folders. What Place refuses is refused. Throws std::runtime_error that names the file and the
// reason.
void write_file(const std::string& path, std::string_view content);
void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes);

// Makes the file if there is none. Throws as write_file() does.
void append_to_file(const std::string& path, std::string_view content);

// The name beside `path` under which write_file() writes before it renames, or that and a number if there is
// such a file. Empty if it writes to `path` directly.
std::string partial_path(const std::string& path);

// Empty if write_file() may write there. Otherwise what another user has put there (sim/host/place.hpp),
// or that nobody reads the pipe that is there, and what to do.
std::string fault_of_place(const std::string& path);

// Empty if write_file() can make the file that it writes first, or needs none. Otherwise why not, and what to
// do.
std::string fault_of_new_file(const std::string& path);

}  // namespace tumblesight::sim

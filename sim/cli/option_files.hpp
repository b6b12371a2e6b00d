// The files that options name: whether two of them are the same file, and whether a file can be written. The
// verbs check this before they begin, because their work may take hours.
#pragma once

#include <string>
#include <vector>

namespace tumblesight::sim {

// A file that a run reads or writes, and the option that names it. An empty path: none.
struct OptionFile {
  std::string option;
  std::string path;
};
using OptionFiles = std::vector<OptionFile>;

// Absolute; links, "." and ".." are resolved as far as the path exists.
std::string full_path(const std::string& path);

// However the paths are spelled, and through links as well. False if one of them is empty.
bool is_same_file(const std::string& path, const std::string& other);
// Throws ArgumentFault that names both options if a file that is written is also read, or is written
// twice.
void require_separate_files(const OptionFiles& read, const OptionFiles& written);
// Every verb calls it before it writes. The same, and throws as require_writable() does.
void require_usable_files(const OptionFiles& read, const OptionFiles& written);

// Creates the folder if it does not exist. Throws std::runtime_error that names option, folder and reason if
// that fails or no file can be written into it.
void require_folder(const std::string& option, const std::string& path);

// Throws std::runtime_error that names option, file, reason and remedy if write_file() could not write
// `path`. Leaves no file behind.
void require_writable(const std::string& option, const std::string& path);

}  // namespace tumblesight::sim

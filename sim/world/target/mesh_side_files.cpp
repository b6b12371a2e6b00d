#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sim/world/target/gltf_file.hpp"
#include "sim/world/target/mesh_file.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

std::string without_outer_spaces(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

// After "mtllib": one name, which may hold spaces, or several.
void append_libraries(const std::string& names, const fs::path& folder, std::vector<std::string>& files) {
  files.push_back((folder / names).string());
  std::istringstream words(names);
  for (std::string word; words >> word;) {
    if (word != names) files.push_back((folder / word).string());
  }
}

std::vector<std::string> libraries_of_obj(const fs::path& path) {
  // What readers look for if the file does not name it.
  std::vector<std::string> files{fs::path(path).replace_extension(".mtl").string()};
  constexpr std::size_t kKeyword = 6;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::string statement = without_outer_spaces(line);
    if (statement.compare(0, kKeyword, "mtllib") != 0) continue;
    const std::string names = without_outer_spaces(statement.substr(kKeyword));
    if (!names.empty()) append_libraries(names, path.parent_path(), files);
  }
  return files;
}

std::vector<std::string> parts_of_gltf(const fs::path& path) {
  std::vector<std::string> files;
  gltf::json json;
  try {
    json = gltf::read_gltf(path.string()).scene;
  } catch (const std::exception&) {  // the reader of the surface says what is wrong
    return files;
  }
  for (const char* list : {"buffers", "images"}) {
    const auto found = json.find(list);
    if (found == json.end() || !found->is_array()) continue;
    for (const auto& part : *found) {
      const auto uri = part.is_object() ? part.find("uri") : part.end();
      if (uri == part.end() || !uri->is_string()) continue;
      const auto text = uri->get<std::string>();
      // What leads out of the folder is not opened.
      if (!gltf::is_data_uri(text) && !gltf::is_outside_address(text))
        files.push_back(gltf::side_file(path.parent_path(), text).string());
    }
  }
  return files;
}

}  // namespace

std::string decoded_uri(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto is_digit = [&](std::size_t at) {
      return at < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[at])) != 0;
    };
    const bool escaped = uri[i] == '%' && is_digit(i + 1) && is_digit(i + 2);
    text += escaped ? static_cast<char>(std::strtol(uri.substr(i + 1, 2).c_str(), nullptr, 16)) : uri[i];
    if (escaped) i += 2;
  }
  return text;
}

std::vector<std::string> mesh_side_files(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  if (extension == ".obj") return libraries_of_obj(path);
  if (extension == ".gltf") return parts_of_gltf(path);
  return {};
}

}  // namespace tumblesight::sim

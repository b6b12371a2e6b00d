#include "sim/console/page_files.hpp"

#include <fstream>
#include <iterator>
#include <map>

namespace tumblesight::sim {
namespace {

struct Contained {
  const char* name;
  const char* text;
  std::size_t size;
};
#include "sim/console/page_contents.inc"

struct Library {
  const char* path;
  const char* file;
  const char* package;
};
constexpr Library kLibraries[] = {
    {"/three.js", "/usr/share/javascript/three/three.min.js", "libjs-three"},
    {"/dygraph.js", "/usr/share/javascript/dygraphs/dygraph.min.js", "libjs-dygraphs"},
    {"/dygraph.css", "/usr/share/javascript/dygraphs/dygraph.min.css", "libjs-dygraphs"}};

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}
const char* type_of(std::string_view name) {
  if (ends_with(name, ".html")) return "text/html; charset=utf-8";
  if (ends_with(name, ".css")) return "text/css; charset=utf-8";
  if (ends_with(name, ".js")) return "text/javascript; charset=utf-8";
  return "image/svg+xml";
}

struct Files {
  std::map<std::string, PageFile, std::less<>> by_path;
  std::map<std::string, std::string> libraries;  // their contents
  std::string missing;

  Files() {
    for (const Contained& file : kContained) {
      const PageFile page{type_of(file.name), {file.text, file.size}};
      by_path["/" + std::string(file.name)] = page;
      if (std::string_view(file.name) == "index.html") by_path["/"] = page;
    }
    for (const Library& library : kLibraries) {
      std::ifstream file(library.file, std::ios::binary);
      std::string& content = libraries[library.path];
      content.assign(std::istreambuf_iterator<char>(file), {});
      by_path[library.path] = {type_of(library.path), content};
      if (content.empty() && missing.empty())
        missing = std::string(library.file) + " is missing: apt-get install " + library.package;
    }
  }
};
const Files& files() {
  static const Files all;
  return all;
}

}  // namespace

const PageFile* page_file(const std::string& path) {
  const auto found = files().by_path.find(path);
  return found == files().by_path.end() ? nullptr : &found->second;
}

std::string missing_libraries() {
  return files().missing;
}

}  // namespace tumblesight::sim

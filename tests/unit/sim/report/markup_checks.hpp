// Faults in HTML pages and the SVG within them.
#pragma once

#include <algorithm>
#include <regex>
#include <string>
#include <vector>

namespace tumblesight::sim {

// Empty if every element of the XML text is closed in order and every attribute is quoted; otherwise the
// fault.
inline std::string xml_fault(const std::string& xml) {
  static const std::regex tag(R"rx(<(/?)([a-z]+)((?:\s+[a-zA-Z0-9:-]+="[^"<]*")*)\s*(/?)>)rx");
  std::vector<std::string> open;
  std::size_t seen = 0;
  for (std::sregex_iterator it(xml.begin(), xml.end(), tag), end; it != end; ++it, ++seen) {
    const std::string name = (*it)[2];
    if ((*it)[1].length() > 0) {
      if (open.empty() || open.back() != name) return "</" + name + "> out of order";
      open.pop_back();
    } else if ((*it)[4].length() == 0) {
      open.push_back(name);
    }
  }
  const auto brackets = static_cast<std::size_t>(std::count(xml.begin(), xml.end(), '<'));
  if (brackets != seen) return "something that is not a well-formed tag";
  return open.empty() ? "" : "<" + open.back() + "> not closed";
}

inline std::vector<std::string> svgs_of(const std::string& html) {
  std::vector<std::string> found;
  for (std::size_t at = html.find("<svg"); at != std::string::npos; at = html.find("<svg", at + 1)) {
    found.push_back(html.substr(at, html.find("</svg>", at) + 6 - at));
  }
  return found;
}

// A reference of a page to something outside it, or a script; empty: none.
inline std::string outside_reference(std::string html) {
  html = std::regex_replace(html, std::regex("xmlns=\"http://www.w3.org/2000/svg\""), "");
  for (const char* outside : {"http:", "https:", "<script", "<link", "src=", "@import", "url("}) {
    if (html.find(outside) != std::string::npos) return outside;
  }
  return "";
}

}  // namespace tumblesight::sim

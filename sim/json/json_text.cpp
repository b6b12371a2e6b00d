#include "sim/json/json_text.hpp"

#include <nlohmann/json.hpp>

namespace tumblesight::sim {
namespace {

// Follows the text up to where a parser would find it damaged; what comes after that is never nested.
bool is_deeper_than(std::string_view text, std::size_t limit) {
  std::size_t depth = 0;
  bool is_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_string) {
      if (c == '\\') ++i;
      if (c == '"') is_string = false;
      continue;
    }
    if (c == '"') is_string = true;
    if ((c == '[' || c == '{') && ++depth > limit) return true;
    if ((c == ']' || c == '}') && depth > 0) --depth;
  }
  return false;
}

}  // namespace

std::string json_refusal(std::string_view text, const JsonLimits& limits) {
  if (text.size() > limits.bytes)
    return "its JSON has " + std::to_string(text.size()) + " bytes; at most " + std::to_string(limits.bytes);
  if (is_deeper_than(text, limits.depth))
    return "its JSON is nested more than " + std::to_string(limits.depth) + " deep";
  return {};
}

template <class Json>
Json parse_json(std::string_view text, const JsonLimits& limits) {
  const std::string refusal = json_refusal(text, limits);
  if (!refusal.empty()) throw std::invalid_argument(refusal);
  try {
    return Json::parse(text);
  } catch (const typename Json::parse_error& error) {
    throw std::invalid_argument("its JSON is damaged at byte " + std::to_string(error.byte));
  } catch (const typename Json::exception&) {  // a number beyond every double
    throw std::invalid_argument("its JSON has a number that is out of range");
  }
}

template nlohmann::json parse_json(std::string_view, const JsonLimits&);
template nlohmann::ordered_json parse_json(std::string_view, const JsonLimits&);

}  // namespace tumblesight::sim

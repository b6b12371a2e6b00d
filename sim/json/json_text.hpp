// JSON text from outside, as a value. Depth and size are checked before a value is built: the library copies,
// compares and writes nested values by recursion, so that a short text of brackets exhausts a small stack.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace tumblesight::sim {

struct JsonLimits {
  std::size_t depth = 32;             // objects and lists within one another
  std::size_t bytes = 1'000'000'000;  // of the text
};

// Why the text is not parsed: "its JSON is nested more than 32 deep"; empty: it is within the limits. In time
// proportional to the text, without recursion. Brackets in strings do not count. The text may be damaged.
std::string json_refusal(std::string_view text, const JsonLimits& limits = {});

// Throws std::invalid_argument with json_refusal() or "its JSON is damaged at byte 17". `Json`:
// nlohmann::json or nlohmann::ordered_json.
template <class Json = nlohmann::json>
Json parse_json(std::string_view text, const JsonLimits& limits = {});

}  // namespace tumblesight::sim

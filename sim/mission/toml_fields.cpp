#include "sim/mission/toml_fields.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "sim/host/nearest_name.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

std::string text_of(const toml::node& node) {
  std::ostringstream text;
  node.visit([&text](const auto& value) { text << value; });
  return shortened(text.str());
}

// Whole numbers count as numbers: 60 is 60.0.
std::optional<double> number_of(const toml::node& node, double lowest, double highest) {
  if (!node.is_floating_point() && !node.is_integer()) return std::nullopt;
  const double value = *node.value<double>();
  if (!(value >= lowest && value <= highest)) return std::nullopt;
  return value;
}

std::string name_of_table(const std::string& table) {
  const std::size_t first = table.find_first_not_of('[');
  return table.substr(first, table.find_first_of(']') - first);
}

std::string text_of(const KnownKeys& known) {
  std::string text = fmt::format("{}", fmt::join(known.keys, ", "));
  if (!known.tables.empty()) text += fmt::format(" and the tables {}", fmt::join(known.tables, ", "));
  return text;
}

}  // namespace

const toml::node* TomlFields::node(std::string_view key) const {
  return table_.get(key);
}

std::string TomlFields::full(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

void TomlFields::fail(std::string_view key, const std::string& fault) const {
  const toml::node* found = table_.get(key);
  const toml::source_position at = found != nullptr ? found->source().begin : table_.source().begin;
  throw std::invalid_argument(fmt::format("{}, line {}: {}", file_, at.line, fault));
}

void TomlFields::refuse(std::string_view key, const std::string& limits) const {
  const toml::node* found = table_.get(key);
  fail(key, fmt::format("{} is {}; it must be {}", full(key), found != nullptr ? text_of(*found) : "missing",
                        limits));
}

std::optional<double> TomlFields::number(std::string_view key, double lowest, double highest) {
  const toml::node* found = node(key);
  if (found == nullptr) return std::nullopt;
  const std::optional<double> value = number_of(*found, lowest, highest);
  if (!value) refuse(key, fmt::format("a number from {:g} to {:g}", lowest, highest));
  return value;
}

std::optional<int> TomlFields::whole_number(std::string_view key, int lowest, int highest) {
  const toml::node* found = node(key);
  if (found == nullptr) return std::nullopt;
  const std::optional<std::int64_t> value = found->is_integer() ? found->value<std::int64_t>() : std::nullopt;
  if (!value || *value < lowest || *value > highest)
    refuse(key, fmt::format("a whole number from {} to {}", lowest, highest));
  return static_cast<int>(*value);
}

std::optional<std::string> TomlFields::text(std::string_view key) {
  const toml::node* found = node(key);
  if (found == nullptr) return std::nullopt;
  const std::optional<std::string> value = found->is_string() ? found->value<std::string>() : std::nullopt;
  if (!value || value->empty()) refuse(key, "a text in quotation marks, not empty");
  return value;
}

std::optional<std::string> TomlFields::choice(std::string_view key, const std::vector<std::string>& choices) {
  const toml::node* found = node(key);
  if (found == nullptr) return std::nullopt;
  const std::optional<std::string> value = found->value<std::string>();
  std::string names;
  for (const std::string& one : choices) {
    if (value == one) return value;
    names += fmt::format("{}\"{}\"", names.empty() ? "" : " or ", one);
  }
  refuse(key, names);
}

std::optional<std::vector<double>> TomlFields::numbers(std::string_view key, double lowest, double highest) {
  const toml::node* found = node(key);
  if (found == nullptr) return std::nullopt;
  const std::string limits = fmt::format("a list of numbers from {:g} to {:g}", lowest, highest);
  if (!found->is_array()) refuse(key, limits);
  std::vector<double> values;
  for (const toml::node& element : *found->as_array()) {
    const std::optional<double> value = number_of(element, lowest, highest);
    if (!value) refuse(key, limits);
    values.push_back(*value);
  }
  return values;
}

std::vector<std::string> TomlFields::texts(std::string_view key) {
  const toml::node* found = node(key);
  if (found == nullptr) return {};
  if (!found->is_array()) refuse(key, "a list of texts, [\"...\"]");
  std::vector<std::string> values;
  for (const toml::node& element : *found->as_array()) {
    if (!element.is_string()) refuse(key, "a list of texts, [\"...\"]");
    values.push_back(*element.value<std::string>());
  }
  return values;
}

std::optional<TomlFields> TomlFields::table(std::string_view key) {
  const toml::node* found = node(key);
  if (found == nullptr) return std::nullopt;
  if (!found->is_table()) refuse(key, fmt::format("a table: [{}]", full(key)));
  return TomlFields(*found->as_table(), file_, full(key));
}

std::vector<std::string> TomlFields::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, value] : table_) names.emplace_back(key.str());
  return names;
}

void TomlFields::require_known(const KnownKeys& known) const {
  std::vector<std::string> names = known.keys;
  for (const std::string& table : known.tables) names.push_back(name_of_table(table));
  for (const auto& [node_key, value] : table_) {
    const std::string key(node_key.str());
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    const std::string has =
        fmt::format("{} has {}", path_.empty() ? "the file" : fmt::format("[{}]", path_), text_of(known));
    fail(key, fmt::format("there is no key '{}'; {}{}", full(shortened(key)), has, did_you_mean(key, names)));
  }
}

}  // namespace tumblesight::sim

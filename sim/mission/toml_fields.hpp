// TomlFields: one table of a TOML file. Takes its keys one by one and refuses what is not as it must be, by
// file, line, key, value and limits. Keys that are not known are refused first: one that is missing may be
// misspelt.
#pragma once

#include <fmt/format.h>
#include <toml++/toml.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tumblesight::sim {

struct KnownKeys {
  std::vector<std::string> keys;
  std::vector<std::string> tables{};  // as they are written in the file: "[goals]", "[[run]]"
};

class TomlFields {
 public:
  // `path`: of the table in the file, empty for the whole. The table must outlive this object.
  TomlFields(const toml::table& table, std::string file, std::string path)
      : table_(table), file_(std::move(file)), path_(std::move(path)) {}

  bool has(std::string_view key) const { return table_.contains(key); }

  // Empty if the key is not there. Each throws std::invalid_argument.
  std::optional<double> number(std::string_view key, double lowest, double highest);
  std::optional<int> whole_number(std::string_view key, int lowest, int highest);
  std::optional<std::string> text(std::string_view key);  // not empty
  std::optional<std::string> choice(std::string_view key, const std::vector<std::string>& choices);
  std::optional<std::vector<double>> numbers(std::string_view key, double lowest, double highest);
  std::vector<std::string> texts(std::string_view key);
  const toml::node* node(std::string_view key) const;  // nullptr if it is not there
  std::optional<TomlFields> table(std::string_view key);
  std::vector<std::string> keys() const;

  // Refuses other keys, with the known one that was probably meant. To be called before any key is taken.
  void require_known(const KnownKeys& known) const;

  // "mission.toml, line 3: goals.nominal.mean is 'x'; it must be LIMITS"
  [[noreturn]] void refuse(std::string_view key, const std::string& limits) const;
  [[noreturn]] void fail(std::string_view key, const std::string& fault) const;
  std::string full(std::string_view key) const;

 private:
  const toml::table& table_;
  std::string file_, path_;
};

}  // namespace tumblesight::sim

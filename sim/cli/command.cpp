#include "sim/cli/command.hpp"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>

namespace tumblesight::sim {

CommandOption CommandOption::check(const ValueCheck& check) {
  option_->check(CLI::Validator(check.fault_of, "", check.name));
  return *this;
}

CommandOption CommandOption::type_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}

CommandOption CommandOption::capture_default_str() {
  option_->capture_default_str();
  return *this;
}

CommandOption CommandOption::default_str(const std::string& text) {
  option_->default_str(text);
  return *this;
}

CommandOption CommandOption::description(const std::string& text) {
  option_->description(text);
  return *this;
}

CommandOption CommandOption::group(const std::string& name) {
  option_->group(name);
  return *this;
}

CommandOption CommandOption::required() {
  option_->required();
  return *this;
}

CommandOption CommandOption::needs(CommandOption other) {
  option_->needs(other.option_);
  return *this;
}

CommandOption CommandOption::excludes(CommandOption other) {
  option_->excludes(other.option_);
  return *this;
}

CommandOption CommandOption::expected(int values) {
  option_->expected(values);
  return *this;
}

CommandOption CommandOption::delimiter(char separator) {
  option_->delimiter(separator);
  return *this;
}

CommandOption CommandOption::allow_extra_args(bool several_values) {
  option_->allow_extra_args(several_values);
  return *this;
}

std::size_t CommandOption::count() const {
  return option_->count();
}

std::string CommandOption::get_name() const {
  return option_->get_name();
}

std::string CommandOption::get_description() const {
  return option_->get_description();
}

std::vector<std::string> CommandOption::get_lnames() const {
  return option_->get_lnames();
}

int CommandOption::get_items_expected_min() const {
  return option_->get_items_expected_min();
}

int CommandOption::get_items_expected_max() const {
  return option_->get_items_expected_max();
}

template <class Value>
CommandOption Command::add_option(const std::string& name, Value& value, const std::string& help) {
  return CommandOption(app_->add_option(name, value, help));
}

template <class Value>
CommandOption Command::add_option_function(const std::string& name,
                                           const std::function<void(const Value&)>& take,
                                           const std::string& help) {
  return CommandOption(app_->add_option_function<Value>(name, take, help));
}

CommandOption Command::add_flag(const std::string& name, bool& value, const std::string& help) {
  return CommandOption(app_->add_flag(name, value, help));
}

CommandOption Command::add_flag_function(const std::string& name, const std::function<void(bool)>& take,
                                         const std::string& help) {
  return CommandOption(app_->add_flag_function(
      name, [take](std::int64_t times) { take(times > 0); }, help));
}

Command Command::add_subcommand(const std::string& name, const std::string& summary) {
  return Command(*app_->add_subcommand(name, summary));
}

void Command::require_subcommand(int count) {
  app_->require_subcommand(count);
}

void Command::footer(const std::string& text) {
  app_->footer(text);
}

void Command::callback(const std::function<void()>& work) {
  app_->callback(work);
}

void Command::parse_complete_callback(const std::function<void()>& check) {
  app_->parse_complete_callback(check);
}

CommandOption Command::get_option(const std::string& name) const {
  return CommandOption(app_->get_option(name));
}

CommandOption Command::get_option_no_throw(const std::string& name) const {
  return CommandOption(app_->get_option_no_throw(name));
}

std::vector<CommandOption> Command::get_options() const {
  std::vector<CommandOption> options;
  for (CLI::Option* option : app_->get_options({})) options.emplace_back(option);
  return options;
}

std::size_t Command::count(const std::string& option) const {
  return app_->count(option);
}

template CommandOption Command::add_option(const std::string&, int&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::uint32_t&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::uint64_t&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::int64_t&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::optional<std::uint32_t>&,
                                           const std::string&);
template CommandOption Command::add_option(const std::string&, std::vector<std::uint32_t>&,
                                           const std::string&);
template CommandOption Command::add_option(const std::string&, double&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::string&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::vector<double>&, const std::string&);
template CommandOption Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template CommandOption Command::add_option_function(const std::string&,
                                                    const std::function<void(const std::string&)>&,
                                                    const std::string&);
template CommandOption Command::add_option_function(
    const std::string&, const std::function<void(const std::vector<std::string>&)>&, const std::string&);

}  // namespace tumblesight::sim

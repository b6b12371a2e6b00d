// A command and its options, as the verbs declare them: the part of CLI11 that they use, under its names.
// CLI11 itself takes seconds to compile, so that only the files that parse include it.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tumblesight::sim {

// An option whose value is wrong: "--name: what is wrong with it".
class ArgumentFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ArgumentFault(const std::string& option, const std::string& fault)
      : std::runtime_error(option + ": " + fault) {}
};

// Ends the program with a status of exit_status.hpp, 0 included. All is said already.
class Exit : public std::exception {
 public:
  explicit Exit(int exit_status) : status(exit_status) {}
  const char* what() const noexcept override { return "the program ends"; }
  const int status;
};

// What is wrong with a value; empty: nothing.
struct ValueCheck {
  std::function<std::string(std::string&)> fault_of;
  std::string name;  // of what the value has to be
};

// An option of a command. A handle, as a pointer is: nullptr means that there is none.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option* option) : option_(option) {}
  CommandOption* operator->() { return this; }
  const CommandOption* operator->() const { return this; }
  explicit operator bool() const { return option_ != nullptr; }

  CommandOption check(const ValueCheck& check);
  CommandOption type_name(const std::string& name);  // of its value, in the help
  CommandOption capture_default_str();               // shows the variable's value as the default
  CommandOption default_str(const std::string& text);
  CommandOption description(const std::string& text);
  CommandOption group(const std::string& name);  // in the help; "": not shown
  CommandOption required();
  CommandOption needs(CommandOption other);
  CommandOption excludes(CommandOption other);
  CommandOption expected(int values);
  CommandOption delimiter(char separator);  // between the values of one argument
  CommandOption allow_extra_args(bool several_values);

  std::size_t count() const;  // how often the command line has it
  std::string get_name() const;
  std::string get_description() const;
  std::vector<std::string> get_lnames() const;  // without their dashes
  int get_items_expected_min() const;
  int get_items_expected_max() const;

 private:
  friend class Command;
  CLI::Option* option_;
};

// A command or one of its subcommands. A handle, as a pointer is: a callback that needs it takes a copy,
// since the handle that it is given is gone when the words are parsed.
class Command {
 public:
  explicit Command(CLI::App& app) : app_(&app) {}

  // `Value`: a type of the instantiations at the end of command.cpp.
  template <class Value>
  CommandOption add_option(const std::string& name, Value& value, const std::string& help = {});
  // `Value`: std::string or a vector of them.
  template <class Value>
  CommandOption add_option_function(const std::string& name, const std::function<void(const Value&)>& take,
                                    const std::string& help);
  CommandOption add_flag(const std::string& name, bool& value, const std::string& help = {});
  CommandOption add_flag_function(const std::string& name, const std::function<void(bool)>& take,
                                  const std::string& help);
  Command add_subcommand(const std::string& name, const std::string& summary);
  void require_subcommand(int count);
  void footer(const std::string& text);
  void callback(const std::function<void()>& work);  // after all is parsed
  void parse_complete_callback(const std::function<void()>& check);

  CommandOption get_option(const std::string& name) const;
  CommandOption get_option_no_throw(const std::string& name) const;
  std::vector<CommandOption> get_options() const;
  std::size_t count(const std::string& option) const;

 private:
  CLI::App* app_;
};

}  // namespace tumblesight::sim

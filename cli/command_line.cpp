#include "cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "cli/commands.h"

namespace wavecrest {

Option Option::required() const { return Option(option_->required()); }
Option Option::showDefault() const { return Option(option_->capture_default_str()); }
Option Option::oneValue() const { return Option(option_->expected(1)); }
Option Option::repeatable() const { return Option(option_->allow_extra_args(false)); }
Option Option::separatedByCommas() const { return Option(option_->delimiter(',')); }
Option Option::positive() const { return Option(option_->check(CLI::PositiveNumber)); }
Option Option::notNegative() const { return Option(option_->check(CLI::NonNegativeNumber)); }
Option Option::between(int low, int high) const { return Option(option_->check(CLI::Range(low, high))); }
Option Option::between(uint64_t low, uint64_t high) const { return Option(option_->check(CLI::Range(low, high))); }
Option Option::between(double low, double high) const { return Option(option_->check(CLI::Range(low, high))); }
Option Option::checkedBy(std::function<std::string(const std::string&)> check) const {
  return Option(option_->check(std::move(check)));
}
bool Option::given() const { return option_->count() > 0; }

Option Command::add(const std::string& name, std::string& value, const std::string& description) const {
  return Option(app_->add_option(name, value, description));
}
Option Command::add(const std::string& name, std::vector<std::string>& value, const std::string& description) const {
  return Option(app_->add_option(name, value, description));
}
Option Command::add(const std::string& name, int& value, const std::string& description) const {
  return Option(app_->add_option(name, value, description));
}
Option Command::add(const std::string& name, uint32_t& value, const std::string& description) const {
  return Option(app_->add_option(name, value, description));
}
Option Command::add(const std::string& name, uint64_t& value, const std::string& description) const {
  return Option(app_->add_option(name, value, description));
}
Option Command::add(const std::string& name, double& value, const std::string& description) const {
  return Option(app_->add_option(name, value, description));
}
void Command::addFlag(const std::string& name, bool& value, const std::string& description) const {
  app_->add_flag(name, value, description);
}
bool Command::given(const std::string& name) const { return app_->get_option(name)->count() > 0; }
void Command::run(std::function<void()> callback) const { app_->callback(std::move(callback)); }

CommandLine::CommandLine(const std::string& description, const std::string& name)
    : app_(std::make_unique<CLI::App>(description, name)) {
  app_->require_subcommand(1);
}
CommandLine::~CommandLine() = default;

void CommandLine::setVersion(const std::string& version) { app_->set_version_flag("--version", version); }

Command CommandLine::add(const std::string& name, const std::string& description) {
  return Command(app_->add_subcommand(name, description));
}

bool CommandLine::parse(std::vector<std::string> arguments, int& exitCode) {
  std::reverse(arguments.begin(), arguments.end());  // CLI11 takes a stack
  try {
    app_->parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);  // --help, --version
    app_->exit(error);
    exitCode = asked ? kExitDone : kExitUsage;
    return false;
  }
  return true;
}

bool readNumber(const std::string& word, int& number) { return CLI::detail::lexical_cast(word, number); }
bool readNumber(const std::string& word, double& number) { return CLI::detail::lexical_cast(word, number); }

}  // namespace wavecrest

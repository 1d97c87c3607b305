#include "cli/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <utility>

#include "cli/commands.h"
#include "cli/describe.h"
#include "cli/messages.h"
#include "cli/variables.h"
#include "library/suggestion.h"

namespace wavecrest {
namespace {

// Connects an option to its environment variable, if it has one. name: as registered, "-m,--method".
CLI::Option* withVariable(CLI::Option* option, const std::string& name) {
  for (const auto& [known, variable] : kVariables) {
    if (name.ends_with(known)) option->envname(variable);
  }
  return option;
}

// Whether one of the arguments names the option.
bool isAmong(const std::vector<std::string>& arguments, const CLI::Option& option) {
  return std::ranges::any_of(arguments, [&](const std::string& word) {
    return word.starts_with('-') && option.check_name(word.substr(0, word.find('=')));
  });
}

// CLI11 reads variables for all commands. Those of commands that are not asked for are not to be read, as a wrong value
// is an error; nor are those of options among the arguments, which come before them.
void forgetUnreadVariables(CLI::App& program, const std::vector<std::string>& arguments) {
  // Help tells of all variables.
  const bool asksHelp = std::ranges::find(arguments, std::string("--help")) != arguments.end();
  for (CLI::App* const command : program.get_subcommands([](CLI::App*) { return true; })) {
    const bool asked = std::ranges::find(arguments, command->get_name()) != arguments.end();
    for (CLI::Option* const option : command->get_options()) {
      if (!asked || (!asksHelp && isAmong(arguments, *option))) option->envname("");
    }
  }
}

// Where a value comes from that a message is about, "--spp: 'abc' is no whole number": the settings file, a variable,
// or nothing to say for an argument.
std::string originOf(const CLI::App& program, const CLI::App& command, const std::vector<std::string>& arguments,
                     const std::string& message) {
  const CLI::Option* const option = command.get_option_no_throw(message.substr(0, message.find(':')));
  if (option == nullptr) return "";
  if (isAmong(arguments, *option)) return "";
  const std::string variable = option->get_envname();
  const char* const value = variable.empty() ? nullptr : std::getenv(variable.c_str());
  if (value != nullptr && message.find(fmt::format("'{}'", value)) != std::string::npos) return variable + ": ";
  const CLI::Option* const file = program.get_config_ptr();
  return file->count() > 0 ? file->as<std::string>() + ": " : "";
}

// Long names of a command's options, with their dashes.
std::vector<std::string> longNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

constexpr const char* kRange = "range";  // the validator that all numbers have

// Lets the option take only numbers of this range. CLI11's own checks would read "010" as 8, accept "nan" in every
// range and read a number that overflows as the largest one.
Option withRange(CLI::Option* option, const NumberRange& range) {
  CLI::Validator* const validator = option->get_validator(kRange);
  validator->operation([range](std::string& word) { return checkNumber(range, word); });
  validator->description(describe(range));
  return Option(option);
}

// Adds a number option that takes all values of its type. The validator sees the word before CLI11 converts it, so it
// can also rewrite the word.
template <class Number>
Option addNumber(CLI::App& app, const std::string& name, Number& value, const std::string& description) {
  CLI::Option* const option = withVariable(app.add_option(name, value, description), name);
  const NumberRange range = rangeOf<Number>();
  option->transform(CLI::Validator([range](std::string& word) { return checkNumber(range, word); }, "", kRange));
  return Option(option);
}

// An empty word is never the name of anything, and file systems have no good words for it.
CLI::Option* notEmpty(CLI::Option* option) {
  return option->check([](const std::string& word) { return word.empty() ? "is empty; expected a value" : ""; });
}

// What is wrong with a settings file; empty if nothing is. Pipes and devices may have no end.
std::string checkSettingsFile(const std::string& file) {
  std::error_code ignored;
  const bool special = std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
  return special ? fmt::format("{} is not a regular file; expected a settings file", file) : "";
}

// Turns CLI11's "--spp: 1 required UINT missing" into "--spp: expected a value". Other texts stay as they are.
std::string withoutTypes(const CLI::ArgumentMismatch& error) {
  std::string text = error.what();
  const size_t end = text.find(": "), required = text.find(" required");
  if (end == std::string::npos || required == std::string::npos) return text;
  const std::string count = text.substr(end + 2, required - end - 2);
  return text.substr(0, end) + (count == "1" ? ": expected a value" : ": expected " + count + " values");
}

// Joins the lines of a message by spaces.
std::string oneLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

Option Option::required() const { return Option(option_->required()); }
Option Option::showDefault() const { return Option(option_->capture_default_str()); }
Option Option::showDefaultAs(const std::string& value) const { return Option(option_->default_str(value)); }
Option Option::oneValue() const { return Option(option_->expected(1)); }
Option Option::valueOr(const std::string& value) const { return Option(option_->expected(0, 1)->default_str(value)); }
Option Option::repeatable() const { return Option(option_->allow_extra_args(false)); }
Option Option::exactly(int values) const { return Option(option_->expected(values)); }
Option Option::separatedByCommas() const { return Option(option_->delimiter(',')); }
Option Option::within(const NumberRange& range) const { return withRange(option_, range); }
Option Option::checkedBy(std::function<std::string(const std::string&)> check) const {
  return Option(option_->check(std::move(check)));
}
bool Option::given() const { return option_->count() > 0; }

Option Command::add(const std::string& name, std::string& value, const std::string& description) const {
  return Option(notEmpty(withVariable(app_->add_option(name, value, description), name)));
}
Option Command::add(const std::string& name, std::vector<std::string>& value, const std::string& description) const {
  return Option(notEmpty(withVariable(app_->add_option(name, value, description), name)));
}
Option Command::add(const std::string& name, int& value, const std::string& description) const {
  return addNumber(*app_, name, value, description);
}
Option Command::add(const std::string& name, uint32_t& value, const std::string& description) const {
  return addNumber(*app_, name, value, description);
}
Option Command::add(const std::string& name, uint64_t& value, const std::string& description) const {
  return addNumber(*app_, name, value, description);
}
Option Command::add(const std::string& name, double& value, const std::string& description) const {
  return addNumber(*app_, name, value, description);
}
void Command::addFlag(const std::string& name, bool& value, const std::string& description) const {
  app_->add_flag(name, value, description);
}
bool Command::given(const std::string& name) const { return app_->get_option(name)->count() > 0; }
bool Command::fromVariable(const std::string& name) const {
  // Options among the arguments have lost their variables (forgetUnreadVariables). What the settings file says counts
  // as a variable's only where both are the same.
  const CLI::Option* const option = app_->get_option(name);
  const std::string variable = option->get_envname();
  const char* const value = variable.empty() ? nullptr : std::getenv(variable.c_str());
  if (value == nullptr || option->results().size() != 1) return false;
  // Of a number, the option has the word as checkNumber has rewritten it.
  std::string number = value;
  checkNumber(rangeOf<uint64_t>(), number);
  const std::string& word = option->results().front();
  return word == value || word == number;
}
void Command::run(std::function<void()> callback) const { app_->callback(std::move(callback)); }

CommandLine::CommandLine(const std::string& description, const std::string& name)
    : app_(std::make_unique<CLI::App>(description, name)) {
  app_->require_subcommand(1);
  // An unknown key in the settings file is an error, so that misspelt options are noticed.
  app_->set_config("--config", "", "settings file (TOML): options of COMMAND under [COMMAND]; variables come after it")
      ->check(checkSettingsFile);
  app_->allow_config_extras(CLI::config_extras_mode::error);
}
CommandLine::~CommandLine() = default;

void CommandLine::setVersion(const std::string& version) { app_->set_version_flag("-V,--version", version); }

Command CommandLine::add(const std::string& name, const std::string& description) {
  CLI::App* const command = app_->add_subcommand(name, description);
  command->fallthrough();  // --config may stand anywhere
  return Command(command);
}

std::vector<std::string> CommandLine::commandNames() const {
  std::vector<std::string> names{"help"};
  for (const CLI::App* command : app_->get_subcommands({})) names.push_back(command->get_name());
  return names;
}

void CommandLine::failParsing(const std::string& what, const std::vector<std::string>& arguments) const {
  const std::vector<CLI::App*> commands = app_->get_subcommands();
  const std::string command = commands.empty() ? "" : " " + commands.front()->get_name();
  // A word that CLI11 could not place: the message suggests the closest option of the command.
  for (const std::string& extra : app_->remaining(true)) {
    std::vector<std::string> known = longNames(commands.empty() ? *app_ : *commands.front());
    const std::string word = extra.substr(0, extra.find('='));
    throw UsageError("unknown argument '" + extra + "'" + didYouMean(word, known) + "; expected those of `wavecrest" +
                     command + " --help`");
  }
  // A key of the settings file that is no option.
  constexpr std::string_view kUnknownKey = "INI was not able to parse ";
  if (what.starts_with(kUnknownKey)) {
    const std::string key = oneLine(what.substr(kUnknownKey.size()));
    const std::string option = "--" + key.substr(key.rfind('.') + 1);
    throw UsageError(app_->get_config_ptr()->as<std::string>() + ": unknown setting '" + key + "'" +
                     didYouMean(option, longNames(commands.empty() ? *app_ : *commands.front())) +
                     "; expected options of a command under [COMMAND]");
  }
  // Everything else: the message of CLI11.
  const std::string origin = commands.empty() ? "" : originOf(*app_, *commands.front(), arguments, what);
  throw UsageError(origin + oneLine(what) + "; see `wavecrest" + command + " --help`");
}

bool CommandLine::parse(std::vector<std::string> arguments, int& exitCode) {
  // `help COMMAND` stands for `COMMAND --help`, and `help` for --help.
  const std::vector<std::string> names = commandNames();
  if (!arguments.empty() && arguments.front() == "help") {
    if (arguments.size() > 2) throw UsageError("help " + arguments[1] + " " + arguments[2] + ": expected one command");
    arguments =
        arguments.size() > 1 ? std::vector{arguments[1], std::string("--help")} : std::vector{std::string("--help")};
  }
  // An unknown command gets a message with all commands and a suggestion.
  const bool isCommand = !arguments.empty() && !arguments.front().starts_with('-');
  if (isCommand && std::find(names.begin(), names.end(), arguments.front()) == names.end()) {
    throw UsageError("unknown command '" + arguments.front() + "'; expected one of " + CLI::detail::join(names, ", ") +
                     didYouMean(arguments.front(), names));
  }
  forgetUnreadVariables(*app_, arguments);
  // CLI11 takes the arguments as a stack, the first one at the end.
  std::vector<std::string> stack(arguments.rbegin(), arguments.rend());
  try {
    app_->parse(std::move(stack));
  } catch (const CLI::ArgumentMismatch& error) {
    failParsing(withoutTypes(error), arguments);
  } catch (const CLI::ParseError& error) {
    // CLI11 throws for --help and --version too. These errors have the exit code of success.
    const bool asked = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);  // --help, --version
    if (!asked) failParsing(error.what(), arguments);
    std::ostringstream text;
    app_->exit(error, text);
    writeStdout(text.str());
    exitCode = kExitDone;
    return false;
  }
  return true;
}

std::string CommandLine::describe(DescriptionKind kind, const std::string& version,
                                  const std::vector<CompletionWords>& values) const {
  return wavecrest::describe(*app_, kind, version, values);
}

}  // namespace wavecrest

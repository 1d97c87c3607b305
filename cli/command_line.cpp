#include "cli/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "cli/commands.h"
#include "cli/describe.h"
#include "cli/suggestion.h"

namespace wavecrest {
namespace {

// Options that a user may want to be the same in every call, and the variables that say so.
constexpr std::pair<const char*, const char*> kVariables[] = {
    {"--threads", "WAVECREST_THREADS"},   {"--isa", "WAVECREST_ISA"},       {"--precision", "WAVECREST_PRECISION"},
    {"--progress", "WAVECREST_PROGRESS"}, {"--memory", "WAVECREST_MEMORY"}, {"--sampler", "WAVECREST_SAMPLER"},
    {"-m,--method", "WAVECREST_METHOD"},  {"--size", "WAVECREST_SIZE"},     {"--seed", "WAVECREST_SEED"}};

CLI::Option* withVariable(CLI::Option* option, const std::string& name) {
  for (const auto& [known, variable] : kVariables) {
    if (name == known) option->envname(variable);
  }
  return option;
}

// Long names of a command's options, with their dashes.
std::vector<std::string> longNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string oneLine(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

Option Option::required() const { return Option(option_->required()); }
Option Option::showDefault() const { return Option(option_->capture_default_str()); }
Option Option::oneValue() const { return Option(option_->expected(1)); }
Option Option::repeatable() const { return Option(option_->allow_extra_args(false)); }
Option Option::exactly(int values) const { return Option(option_->expected(values)); }
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
  return Option(withVariable(app_->add_option(name, value, description), name));
}
Option Command::add(const std::string& name, std::vector<std::string>& value, const std::string& description) const {
  return Option(withVariable(app_->add_option(name, value, description), name));
}
Option Command::add(const std::string& name, int& value, const std::string& description) const {
  return Option(withVariable(app_->add_option(name, value, description), name));
}
Option Command::add(const std::string& name, uint32_t& value, const std::string& description) const {
  return Option(withVariable(app_->add_option(name, value, description), name));
}
Option Command::add(const std::string& name, uint64_t& value, const std::string& description) const {
  return Option(withVariable(app_->add_option(name, value, description), name));
}
Option Command::add(const std::string& name, double& value, const std::string& description) const {
  return Option(withVariable(app_->add_option(name, value, description), name));
}
void Command::addFlag(const std::string& name, bool& value, const std::string& description) const {
  app_->add_flag(name, value, description);
}
bool Command::given(const std::string& name) const { return app_->get_option(name)->count() > 0; }
void Command::run(std::function<void()> callback) const { app_->callback(std::move(callback)); }

CommandLine::CommandLine(const std::string& description, const std::string& name)
    : app_(std::make_unique<CLI::App>(description, name)) {
  app_->require_subcommand(1);
  app_->set_config("--config", "", "settings file (TOML): options of COMMAND under [COMMAND]");
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

void CommandLine::failParsing(const std::string& what) const {
  const std::vector<CLI::App*> commands = app_->get_subcommands();
  const std::string command = commands.empty() ? "" : " " + commands.front()->get_name();
  for (const std::string& extra : app_->remaining(true)) {
    std::vector<std::string> known = longNames(commands.empty() ? *app_ : *commands.front());
    const std::string word = extra.substr(0, extra.find('='));
    throw UsageError("unknown argument '" + extra + "'" + didYouMean(word, known) + "; expected those of `wavecrest" +
                     command + " --help`");
  }
  throw UsageError(oneLine(what) + "; see `wavecrest" + command + " --help`");
}

bool CommandLine::parse(std::vector<std::string> arguments, int& exitCode) {
  const std::vector<std::string> names = commandNames();
  if (!arguments.empty() && arguments.front() == "help") {
    if (arguments.size() > 1) {
      arguments = {arguments[1], "--help"};
    } else {
      arguments = {"--help"};
    }
  }
  const bool isCommand = !arguments.empty() && !arguments.front().starts_with('-');
  if (isCommand && std::find(names.begin(), names.end(), arguments.front()) == names.end()) {
    throw UsageError("unknown command '" + arguments.front() + "'" + didYouMean(arguments.front(), names) +
                     "; expected one of those that `wavecrest help` lists");
  }
  std::reverse(arguments.begin(), arguments.end());  // CLI11 takes a stack
  try {
    app_->parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);  // --help, --version
    if (!asked) failParsing(error.what());
    app_->exit(error);
    exitCode = kExitDone;
    return false;
  }
  return true;
}

std::string CommandLine::describe(DescriptionKind kind, const std::string& version,
                                  const std::vector<CompletionWords>& values) const {
  return wavecrest::describe(*app_, kind, version, values);
}

bool readNumber(const std::string& word, int& number) { return CLI::detail::lexical_cast(word, number); }
bool readNumber(const std::string& word, double& number) { return CLI::detail::lexical_cast(word, number); }

}  // namespace wavecrest

// CommandLine, Command and Option: what the subcommands use of CLI11. Its header alone takes as long to compile as a
// command, so one file includes it (command_line.cpp).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/number_range.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace wavecrest {

enum class DescriptionKind;
struct CompletionWords;

// A handle; the command line owns the option. Checks that fail make CommandLine::parse throw UsageError.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option required() const;
  Option showDefault() const;  // in --help: the value that the variable has now
  Option showDefaultAs(const std::string& value) const;
  Option oneValue() const;
  // May stand without a value and is then `value`, which --help shows.
  Option valueOr(const std::string& value) const;
  Option repeatable() const;  // one value each time
  Option exactly(int values) const;
  Option separatedByCommas() const;
  // Of a number; otherwise it may be all that its variable holds.
  Option within(const NumberRange& range) const;
  Option atLeast(int64_t low) const { return within(WholeRange{low, std::numeric_limits<uint64_t>::max()}); }
  template <std::integral Low, std::integral High>
  Option between(Low low, High high, std::optional<int64_t> also = {}) const {
    return within(WholeRange{static_cast<int64_t>(low), static_cast<uint64_t>(high), also});
  }
  Option between(double low, double high) const { return within(RealRange{low, high}); }
  // range: an OptionRange (library/option_ranges.h).
  template <class Range>
  requires requires(const Range& range) { range.least, range.most; }
  Option between(const Range& range) const { return between(range.least, range.most); }
  // The same, or the word auto, for which the variable gets 0; --help shows it as the default.
  template <class Range>
  Option betweenOrAuto(const Range& range) const {
    return within(RealRange{range.least, range.most, true}).showDefaultAs("auto");
  }
  // check returns what is wrong with a word, or nothing.
  Option checkedBy(std::function<std::string(const std::string&)> check) const;
  bool given() const;

 private:
  CLI::Option* option_;
};

// A handle; the command line owns the subcommand. Options write to variables that must live as long as that.
class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}
  // name: -s,--long, or plain for what is told by its place.
  Option add(const std::string& name, std::string& value, const std::string& description) const;
  Option add(const std::string& name, std::vector<std::string>& value, const std::string& description) const;
  Option add(const std::string& name, int& value, const std::string& description) const;
  Option add(const std::string& name, uint32_t& value, const std::string& description) const;
  Option add(const std::string& name, uint64_t& value, const std::string& description) const;
  Option add(const std::string& name, double& value, const std::string& description) const;
  void addFlag(const std::string& name, bool& value, const std::string& description) const;
  bool given(const std::string& name) const;  // in the arguments, the settings file or a variable, once they are read
  // Whether the value came from a variable: a default, which never contradicts what was asked for.
  bool fromVariable(const std::string& name) const;
  void run(std::function<void()> callback) const;  // then

 private:
  CLI::App* app_;
};

class CommandLine {
 public:
  CommandLine(const std::string& description, const std::string& name);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  void setVersion(const std::string& version);
  Command add(const std::string& name, const std::string& description);
  // Reads the arguments and runs the command that they name, whose exceptions pass; wrong arguments are a UsageError.
  // False if there was nothing to run: exitCode is then kExitDone, after --help, --version or `help COMMAND`.
  //
  // Options that are not among the arguments are taken from the settings file that --config names, and then from
  // environment variables (kVariables).
  bool parse(std::vector<std::string> arguments, int& exitCode);
  // What has been registered, as a man page or for a shell (cli/describe.h).
  std::string describe(DescriptionKind kind, const std::string& version,
                       const std::vector<CompletionWords>& values) const;

 private:
  std::vector<std::string> commandNames() const;
  [[noreturn]] void failParsing(const std::string& what, const std::vector<std::string>& arguments) const;

  std::unique_ptr<CLI::App> app_;
};

}  // namespace wavecrest

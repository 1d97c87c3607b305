#include "cli/describe.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/variables.h"

namespace wavecrest {
namespace {

using Values = std::vector<CompletionWords>;

// An option, or a positional argument (place), as all four formats need it.
struct OptionFacts {
  std::vector<std::string> names;  // "-o", "--output"; of a place its plain name
  std::string description;
  bool place = false, takesValue = false;
  const std::vector<std::string>* words = nullptr;  // that its value may be, if they are known
};

struct CommandFacts {
  std::string name, description;
  std::vector<OptionFacts> options;
};

// The facts of an option, with the words of `values` that complete it.
OptionFacts factsOf(const CLI::Option& option, const std::string& command, const Values& values) {
  OptionFacts facts;
  // Names with their dashes; a positional argument has a plain name only.
  for (const std::string& name : option.get_snames()) facts.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) facts.names.push_back("--" + name);
  facts.place = facts.names.empty();
  if (facts.place) facts.names.push_back(option.get_name());
  facts.description = option.get_description();
  facts.takesValue = option.get_expected_max() > 0 && option.get_type_size_max() > 0;
  // Words for its value, listed under one of its names.
  for (const CompletionWords& value : values) {
    if (!value.command.empty() && value.command != command) continue;
    const bool named = std::any_of(facts.names.begin(), facts.names.end(), [&](const std::string& name) {
      return std::find(value.names.begin(), value.names.end(), name) != value.names.end();
    });
    if (named) facts.words = &value.words;
  }
  return facts;
}

// All commands with their options, in the order of their registration.
std::vector<CommandFacts> commandsOf(const CLI::App& program, const Values& values) {
  std::vector<CommandFacts> all;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    CommandFacts facts{command->get_name(), command->get_description(), {}};
    for (const CLI::Option* option : command->get_options()) {
      facts.options.push_back(factsOf(*option, facts.name, values));
    }
    all.push_back(std::move(facts));
  }
  return all;
}

// ---- man: roff ------------------------------------------------------------------------------------------------------

// Escapes text for roff. A line that began with a period or an apostrophe would be read as a request.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\' || c == '-') out += '\\';
    out += c;
  }
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

std::string manPage(const CLI::App& program, const std::vector<CommandFacts>& commands, const std::string& version) {
  // Name and synopsis.
  std::string page = fmt::format(".TH WAVECREST 1 \"\" \"wavecrest {}\"\n.SH NAME\nwavecrest \\- {}\n", version,
                                 roff(program.get_description()));
  page += ".SH SYNOPSIS\n.B wavecrest\n.I COMMAND\n[OPTIONS]\n.SH COMMANDS\n";
  // A subsection for each command, a tagged paragraph for each option.
  for (const CommandFacts& command : commands) {
    page += fmt::format(".SS {}\n{}\n", roff(command.name), roff(command.description));
    for (const OptionFacts& option : command.options) {
      const char* const value = option.takesValue && !option.place ? " \\fIVALUE\\fR" : "";
      page += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(fmt::format("{}", fmt::join(option.names, ", "))), value,
                          roff(option.description));
    }
  }
  page +=
      ".SH EXIT STATUS\n0 done; 1 internal failure; 2 wrong usage; 3 bad input; 4 a check that was asked for did not "
      "hold; 130 interrupted after saving.\n"
      ".SH ENVIRONMENT\n.TP\n\\fBWAVECREST_SCENES\\fR\nfolder of the built\\-in scenes\n"
      ".TP\n\\fBWAVECREST_MPI\\fR\noff: processes of mpirun or srun do not share a render\n"
      ".TP\n\\fBWAVECREST_MAX_IMAGE\\fR\nmost memory of an image that is read, as 8G; default: 2G; images up "
      "to 16 times their file are always read\n";
  for (const auto& [option, variable] : kVariables) {
    page += fmt::format(".TP\n\\fB{}\\fR\nvalue of {} where neither arguments nor settings file have one\n",
                        roff(variable), roff(option));
  }
  return page;
}

// ---- bash -----------------------------------------------------------------------------------------------------------

// All names of all options of a command, separated by spaces.
std::string optionNames(const CommandFacts& command) {
  std::string names;
  for (const OptionFacts& option : command.options) {
    if (!option.place) names += fmt::format("{}{}", names.empty() ? "" : " ", fmt::join(option.names, " "));
  }
  return names;
}

// A shell function that completes by the command and by the word before the cursor.
std::string bashCompletion(const std::vector<CommandFacts>& commands) {
  std::string names, cases;
  for (const CommandFacts& command : commands) {
    names += (names.empty() ? "" : " ") + command.name;
    // After an option that takes a value: the words that it may be, else file names.
    std::string values, places;
    for (const OptionFacts& option : command.options) {
      if (option.place && option.words) places = fmt::format(" {}", fmt::join(*option.words, " "));
      if (option.place || !option.takesValue) continue;
      const std::string reply = option.words ? fmt::format("_wavecrest_words \"{}\"", fmt::join(*option.words, " "))
                                             : "COMPREPLY=($(compgen -f -- \"$word\"))";
      values += fmt::format("        {}) {}; return ;;\n", fmt::join(option.names, "|"), reply);
    }
    // Elsewhere: option names after a dash, else files and the words of positional arguments.
    cases += fmt::format("    {})\n      case $before in\n{}      esac\n", command.name, values);
    cases += fmt::format("      if [[ $word == -* ]]; then COMPREPLY=($(compgen -W \"{}\" -- \"$word\"))\n",
                         optionNames(command));
    cases += fmt::format("      else COMPREPLY=($(compgen -f -W \"{}\" -- \"$word\")); fi ;;\n", places);
  }
  return fmt::format(R"(# bash completion of wavecrest; printed by `wavecrest describe bash`
# Completes the last of words that are separated by commas.
_wavecrest_words() {{
  local last=${{word##*,}}
  COMPREPLY=($(compgen -P "${{word%"$last"}}" -W "$1" -- "$last"))
}}
_wavecrest() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}}
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W "{} --help --version" -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
}}
complete -o filenames -F _wavecrest wavecrest
)",
                     names, cases);
}

// ---- zsh ------------------------------------------------------------------------------------------------------------

// Escapes text for a single-quoted spec of _arguments, where colons and brackets end a description.
std::string zshText(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == ':' || c == '[' || c == ']' || c == '\\') out += '\\';
    out += c == '\'' ? "'\\''" : std::string(1, c);
  }
  return out;
}

// The specs of an option, one per name, or of a positional argument. The asterisk allows repetition.
std::string zshArgument(const OptionFacts& option) {
  const std::string action = option.words ? fmt::format("({})", fmt::join(*option.words, " ")) : "_files";
  if (option.place) {
    const std::string both = option.words
                                 ? fmt::format("_alternative \"words\\:words\\:{}\" \"files\\:files\\:_files\"",
                                               fmt::format("({})", fmt::join(*option.words, " ")))
                                 : "_files";
    return fmt::format(" \\\n        '*:{}:{}'", zshText(option.names.front()), both);
  }
  std::string text;
  for (const std::string& name : option.names) {
    text += fmt::format(" \\\n        '*{}[{}]{}'", name, zshText(option.description),
                        option.takesValue ? ":value:" + action : "");
  }
  return text;
}

// A shell function that completes the first word by commands, and the others by _arguments of the command.
std::string zshCompletion(const std::vector<CommandFacts>& commands) {
  std::string names, cases;
  for (const CommandFacts& command : commands) {
    names += fmt::format("    '{}:{}'\n", command.name, zshText(command.description));
    std::string arguments;
    bool place = false;  // one spec serves all places
    for (const OptionFacts& option : command.options) {
      if (option.place && place) continue;
      place = place || option.place;
      arguments += zshArgument(option);
    }
    cases += fmt::format("    {})\n      _arguments -s{}\n      ;;\n", command.name, arguments);
  }
  return fmt::format(R"(#compdef wavecrest
# zsh completion of wavecrest; printed by `wavecrest describe zsh`
_wavecrest() {{
  local -a commands=(
{}  )
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  ((CURRENT--))
  case $command in
{}  esac
}}
_wavecrest "$@"
)",
                     names, cases);
}

// ---- fish -----------------------------------------------------------------------------------------------------------

// Escapes text for fish's single quotes.
std::string fishText(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

// One `complete` line for each command and for each option of a command.
std::string fishCompletion(const std::vector<CommandFacts>& commands) {
  std::string text = "# fish completion of wavecrest; printed by `wavecrest describe fish`\n";
  for (const CommandFacts& command : commands) {
    text += fmt::format("complete -c wavecrest -n __fish_use_subcommand -a {} -d '{}'\n", command.name,
                        fishText(command.description));
    const std::string condition = fmt::format("-n '__fish_seen_subcommand_from {}'", command.name);
    for (const OptionFacts& option : command.options) {
      const std::string words = option.words ? fmt::format(" -a '{}'", fmt::join(*option.words, " ")) : "";
      if (option.place) {
        if (option.words) text += fmt::format("complete -c wavecrest {}{}\n", condition, words);
        continue;
      }
      std::string names;
      // -l is for names after two dashes, -s for single letters, -o for longer names after one dash.
      for (const std::string& name : option.names) {
        names +=
            name.starts_with("--") ? " -l " + name.substr(2) : (name.size() == 2 ? " -s " : " -o ") + name.substr(1);
      }
      text += fmt::format("complete -c wavecrest {}{}{}{} -d '{}'\n", condition, names, option.takesValue ? " -r" : "",
                          words, fishText(option.description));
    }
  }
  return text;
}

}  // namespace

std::string describe(const CLI::App& program, DescriptionKind kind, const std::string& version, const Values& values) {
  const std::vector<CommandFacts> commands = commandsOf(program, values);
  switch (kind) {
    case DescriptionKind::man:
      return manPage(program, commands, version);
    case DescriptionKind::bash:
      return bashCompletion(commands);
    case DescriptionKind::zsh:
      return zshCompletion(commands);
    case DescriptionKind::fish:
      return fishCompletion(commands);
  }
  return {};
}

}  // namespace wavecrest

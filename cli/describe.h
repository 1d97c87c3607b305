// The command line described for other programs: its man page, and completions for shells. All of it follows from what
// the commands have registered, so nothing here has to be kept up when an option comes or goes.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace wavecrest {

enum class DescriptionKind { man, bash, zsh, fish };
constexpr std::array<std::string_view, 4> kDescriptionKindNames{"man", "bash", "zsh", "fish"};

// Words that complete values: of options and places of these names; other values are taken for file names. Where
// several fit, the last one does.
struct CompletionWords {
  std::vector<std::string> names;
  std::vector<std::string> words;
  std::string command = {};  // whose options; empty: of all
};

std::string describe(const CLI::App& program, DescriptionKind kind, const std::string& version,
                     const std::vector<CompletionWords>& values);

}  // namespace wavecrest

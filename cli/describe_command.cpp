// wavecrest describe: the man page and completions of this very program.
#include <fmt/core.h>

#include <memory>

#include "cli/commands.h"
#include "cli/describe.h"
#include "engine/methods/method_list.h"
#include "engine/version.h"
#include "library/option_values.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

std::vector<CompletionWords> completionWords() {
  CompletionWords methods{{"--method", "--methods"}, {}}, scenes{{"scene", "scenes", "SCENE"}, {}};
  for (const MethodEntry& entry : kMethods) methods.words.emplace_back(entry.name);
  for (const SceneEntry& entry : builtInScenes()) scenes.words.emplace_back(entry.name);
  CompletionWords kinds{{"FORMAT"}, {kDescriptionKindNames.begin(), kDescriptionKindNames.end()}};
  return {methods, scenes, kinds};
}

}  // namespace

void addDescribeCommand(CommandLine& program, int&) {
  const Command command = program.add("describe", "print the man page, or completions for bash, zsh or fish");
  auto kind = std::make_shared<std::string>();
  command.add("FORMAT", *kind, "man, bash, zsh or fish").required();
  command.run([kind, &program] {
    const size_t chosen = parseChoice("describe", *kind, kDescriptionKindNames);
    fmt::print("{}", program.describe(static_cast<DescriptionKind>(chosen), kVersion, completionWords()));
  });
}

}  // namespace wavecrest

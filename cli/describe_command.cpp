// wavecrest describe: the man page and completions of this very program.
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/campaign/campaign_settings.h"
#include "bench/score/workload.h"
#include "cli/commands.h"
#include "cli/describe.h"
#include "cli/messages.h"
#include "cli/progress.h"
#include "engine/compile/instances.h"
#include "engine/methods/method_list.h"
#include "engine/plan/clock_kind.h"
#include "engine/plan/render_settings.h"
#include "engine/version.h"
#include "kernels/sampling/sampler.h"
#include "library/campaign_options.h"
#include "library/campaign_rows.h"
#include "library/option_values.h"
#include "metrics/metric_list.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

// The words of a list of names.
template <class Names>
CompletionWords named(std::vector<std::string> options, const Names& names, std::string command = {}) {
  return {std::move(options), {std::begin(names), std::end(names)}, std::move(command)};
}

std::vector<CompletionWords> completionWords() {
  std::vector<std::string_view> methods, scenes, profileNames, samplers, metrics;
  for (const MethodEntry& entry : kMethods) methods.push_back(entry.name);
  for (const SceneEntry& entry : builtInScenes()) scenes.push_back(entry.name);
  for (const Profile& profile : profiles()) profileNames.push_back(profile.name);
  for (const SamplerKind kind : kAllSamplerKinds) samplers.push_back(toString(kind));
  std::vector<std::string_view> samplersOrAuto = samplers;
  samplersOrAuto.emplace_back("auto");
  for (const Metric& metric : metricList()) metrics.push_back(metric.name);
  // A reference's method may also be chosen by the program.
  std::vector<std::string_view> referenceMethods{"auto"};
  referenceMethods.insert(referenceMethods.end(), methods.begin(), methods.end());
  return {named({"--method", "--methods"}, methods),
          named({"--methods"}, campaignMethodNames(), "converge"),
          named({"--method"}, referenceMethods, "reference"),
          named({"scene", "scenes", "SCENE"}, scenes),
          named({"FORMAT"}, kDescriptionKindNames),
          named({"--profile"}, profileNames),
          named({"--sampler"}, samplersOrAuto),
          named({"--sampler"}, samplers, "reference"),
          named({"--metrics"}, metrics),
          named({"--isa"}, isaNames()),
          named({"--precision"}, kPrecisionNames),
          named({"--accel"}, kAccelNames),
          named({"--instances"}, kInstancingNames),
          named({"--filter-mode"}, kFilterModeNames),
          named({"--roulette"}, kRouletteNames),
          named({"--guide"}, kGuideTargetNames, "render"),
          named({"--mlt"}, kMetropolisVariantNames),
          named({"--merge-vertices"}, kMergeVerticesNames),
          named({"--clock"}, kClockNames),
          named({"--progress"}, kProgressNames),
          named({"--images"}, kImageChoices),
          named({"--score"}, kScoreSizeNames)};
}

}  // namespace

void addDescribeCommand(CommandLine& program, int&) {
  const Command command = program.add("describe", "print the man page, or completions for bash, zsh or fish");
  auto kind = std::make_shared<std::string>();
  command.add("FORMAT", *kind, "man, bash, zsh or fish").required();
  command.run([kind, &program] {
    const size_t chosen = parseChoice("describe", *kind, kDescriptionKindNames);
    printOut("{}", program.describe(static_cast<DescriptionKind>(chosen), kVersion, completionWords()));
  });
}

}  // namespace wavecrest

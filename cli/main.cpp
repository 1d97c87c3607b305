// wavecrest: one program, one file per subcommand.
#include <fmt/core.h>

#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "engine/load/load.h"
#include "engine/scene/scene_error.h"
#include "engine/version.h"
#include "metrics/image/image.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

int run(std::vector<std::string> arguments) {
  CommandLine program("wavecrest measures light-transport methods against each other", "wavecrest");
  program.setVersion(kVersion);
  int exitCode = kExitDone;
  addCompareCommand(program, exitCode);
  addConvergeCommand(program, exitCode);
  addReferenceCommand(program, exitCode);
  addRenderCommand(program, exitCode);
  addInspectCommand(program, exitCode);
  addReportCommand(program, exitCode);
  addBenchCommand(program, exitCode);
  addScenesCommand(program, exitCode);

  try {
    program.parse(std::move(arguments), exitCode);
  } catch (const UsageError& error) {
    fmt::print(stderr, "wavecrest: error: {}\n", error.what());
    return kExitUsage;
  } catch (const MissingFileError& error) {
    const std::string hint = missingAssetHint(error.file);
    fmt::print(stderr, "wavecrest: error: {}{}\n", error.what(), hint.empty() ? "" : ": " + hint);
    return kExitInput;
  } catch (const LoadError& error) {
    fmt::print(stderr, "wavecrest: error: {}\n", error.what());
    return kExitInput;
  } catch (const SceneError& error) {
    fmt::print(stderr, "wavecrest: error: {}\n", error.what());
    return kExitInput;
  } catch (const ImageError& error) {
    fmt::print(stderr, "wavecrest: error: {}\n", error.what());
    return kExitInput;
  } catch (const InputError& error) {
    fmt::print(stderr, "wavecrest: error: {}\n", error.what());
    return kExitInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "wavecrest: internal error: {}\n", error.what());
    return kExitFailure;
  }
  return exitCode;
}

}  // namespace
}  // namespace wavecrest

int main(int argc, char** argv) { return wavecrest::run({argv + 1, argv + argc}); }

// wavecrest: one program, one file per subcommand.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <exception>

#include "cli/commands.h"
#include "engine/load/load.h"
#include "engine/scene/scene_error.h"
#include "engine/version.h"
#include "metrics/image/image.h"
#include "scenes/scene_list.h"

int main(int argc, char** argv) {
  using namespace wavecrest;
  CLI::App app{"wavecrest measures light-transport methods against each other", "wavecrest"};
  app.set_version_flag("--version", std::string(kVersion));
  app.require_subcommand(1);
  int exitCode = kExitDone;
  addCompareCommand(app, exitCode);
  addConvergeCommand(app, exitCode);
  addReferenceCommand(app, exitCode);
  addRenderCommand(app, exitCode);
  addInspectCommand(app, exitCode);
  addReportCommand(app, exitCode);
  addBenchCommand(app, exitCode);
  addScenesCommand(app, exitCode);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success);  // --help, --version
    app.exit(error);
    return asked ? kExitDone : kExitUsage;
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

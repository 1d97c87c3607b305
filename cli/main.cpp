// wavecrest: one program, one file per subcommand.
#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bench/against/child_render.h"
#include "bench/checkpoint/checkpoint.h"
#include "cli/commands.h"
#include "cli/file_check.h"
#include "cli/messages.h"
#include "engine/load/load.h"
#include "engine/scene/scene_error.h"
#include "engine/version.h"
#include "library/translate.h"
#include "metrics/image/image.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

constexpr const char* kOutOfMemory =
    "wavecrest: error: out of memory; expected a smaller film or scene, fewer --threads, or a budget by --memory";

// Says what went wrong and returns the exit code of its kind.
int report(const std::exception_ptr& thrown) {
  const auto line = [](int exitCode, const std::string& text) {
    tell("wavecrest: error: {}", text);
    return exitCode;
  };
  try {
    std::rethrow_exception(thrown);
  } catch (const UsageError& error) {
    return line(kExitUsage, error.what());
  } catch (const MissingFileError& error) {
    return line(kExitInput, textOf(error));
  } catch (const LoadError& error) {
    return line(kExitInput, error.what());
  } catch (const SceneError& error) {
    return line(kExitInput, error.what());
  } catch (const SceneFolderError& error) {
    return line(kExitInput, error.what());
  } catch (const ImageError& error) {
    return line(kExitInput, error.what());
  } catch (const CheckpointError& error) {
    return line(kExitInput, error.what());
  } catch (const InputError& error) {
    return line(kExitInput, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return line(kExitInput, fmt::format("{}: {}; expected a file or folder that can be reached", error.path1().string(),
                                        error.code().message()));
  } catch (const nlohmann::json::exception&) {
    return line(kExitInput, "JSON of an input is not as wavecrest writes it; expected it unchanged");
  } catch (const ChildStopped& error) {
    return line(kExitInterrupted, error.what());
  } catch (const std::bad_alloc&) {
    writeStderr(kOutOfMemory);
    writeStderr("\n");
  } catch (const std::exception& error) {
    // The standard library's threads and TBB's fail with texts of their own, which end alike.
    const std::string text = error.what();
    const bool thread = text.ends_with(std::strerror(EAGAIN));
    tell("wavecrest: {}: {}{}", thread ? "error" : "internal error", text,
         thread ? "; expected enough memory and processes for all threads, or fewer --threads" : "");
  } catch (...) {
    tell("wavecrest: internal error");
  }
  return kExitFailure;
}

// Of an exception that no frame can catch, as where a library fails to start its thread. Several threads may fail at
// once; the first one speaks.
[[noreturn]] void onTerminate() {
  static std::atomic_flag reported;
  while (reported.test_and_set()) pause();
  if (const std::exception_ptr thrown = std::current_exception()) report(thrown);
  _exit(kExitFailure);
}

// What the shell has closed is opened on nothing, or the first image would be taken for stdout or stderr.
void openStandardStreams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    if (open("/dev/null", descriptor == STDIN_FILENO ? O_RDONLY : O_WRONLY) != descriptor) _exit(kExitFailure);
  }
}

// At a limit of CPU time, where a command has nothing to save.
void onCpuLimit(int) {
  writeStderr("wavecrest: interrupted at the limit of CPU time\n");
  _exit(kExitInterrupted);
}

int run(std::vector<std::string> arguments) {
  int exitCode = kExitDone;
  try {
    CommandLine program("wavecrest measures light-transport methods against each other", "wavecrest");
    program.setVersion(kVersion);
    addCompareCommand(program, exitCode);
    addConvergeCommand(program, exitCode);
    addReferenceCommand(program, exitCode);
    addRenderCommand(program, exitCode);
    addMergeCommand(program, exitCode);
    addInspectCommand(program, exitCode);
    addRecommendCommand(program, exitCode);
    addConvertCommand(program, exitCode);
    addReportCommand(program, exitCode);
    addBenchCommand(program, exitCode);
    addScenesCommand(program, exitCode);
    addDescribeCommand(program, exitCode);
    program.parse(std::move(arguments), exitCode);
  } catch (const std::system_error&) {
    // fmt::print throws where stdout does not take a full buffer; the state of the stream tells of that below.
    if (std::ferror(stdout) == 0) exitCode = report(std::current_exception());
  } catch (...) {
    exitCode = report(std::current_exception());
  }
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written || readerHasLeft()) return exitCode;
  tell("wavecrest: error: stdout: writing failed: {}; expected somebody who reads", std::strerror(errno));
  return exitCode == kExitDone ? kExitFailure : exitCode;
}

}  // namespace
}  // namespace wavecrest

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);  // a reader that goes away ends no render
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows beyond a limit is an error of writing
  std::signal(SIGUSR1, SIG_IGN);  // before there is anything to save; commands that save set their own
  std::signal(SIGXCPU, wavecrest::onCpuLimit);
  std::set_terminate(wavecrest::onTerminate);
  wavecrest::openStandardStreams();
  return wavecrest::run({argv + 1, argv + argc});
}

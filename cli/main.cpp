// wavecrest: one program, one file per subcommand.
#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/ranks/launch.h"
#include "cli/commands.h"
#include "cli/failure.h"
#include "cli/messages.h"
#include "engine/version.h"

namespace wavecrest {
namespace {

// Says what went wrong and returns the exit code of its kind.
int report(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const SharedFailure& shared) {
    return shared.exitCode;
  } catch (...) {
    const Failure failure = failureOf(std::current_exception());
    const std::optional<Launch> launch = launchOfThisProcess();
    if (launch && launch->rank != 0 && failure.exitCode == kExitUsage) {
      // All processes have the same arguments, and the first one says what is wrong. Launchers end all once one has
      // failed, so that one gets the time to say it.
      constexpr useconds_t kSpeech = 500'000;
      usleep(kSpeech);
    } else {
      tell("wavecrest: {}", failure.line);
    }
    return failure.exitCode;
  }
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

// The first word after options of the program itself, of which --config has a value; empty: none.
std::string commandOf(const std::vector<std::string>& arguments) {
  for (size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--config") {
      ++i;
    } else if (!arguments[i].starts_with('-')) {
      return arguments[i];
    }
  }
  return {};
}

// Only a render shares its work between the processes of a launcher. Any other command would do everything in each of
// them, and all would write the same files.
void refuseLaunched(const std::vector<std::string>& arguments) {
  const std::optional<Launch> launch = launchOfThisProcess();
  constexpr std::array<std::string_view, 4> kAny{"render", "help", "scenes", "describe"};
  const std::string command = commandOf(arguments);
  if (!launch || command.empty() || std::find(kAny.begin(), kAny.end(), command) != kAny.end()) return;
  throw UsageError(fmt::format(
      "{}: {} has started {} processes, which only `render` can share its work between; expected one process, "
      "or {}=off, with which each works by itself",
      command, launch->by, launch->ranks, kMpiVariable));
}

int run(std::vector<std::string> arguments) {
  int exitCode = kExitDone;
  try {
    refuseLaunched(arguments);
    CommandLine program("wavecrest measures light-transport methods against each other", "wavecrest");
    program.setVersion(fmt::format("{} ({})", kVersion, kCommit));
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
  } catch (...) {
    exitCode = report(std::current_exception());
  }
  const std::string unsaid = takeStdoutFailure();
  if (unsaid.empty()) return exitCode;
  tell("wavecrest: error: {}", unsaid);
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

// Damaged files (tests/load/fuzz_cases.h) given to the program itself: `wavecrest inspect`, which loads a scene,
// compiles it and walks paths through it, ends with status 0 or 3, within its time and memory.
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <map>

#include "tests/load/fuzz_cases.h"

extern char** environ;

namespace wavecrest {
namespace {

struct Ending {
  int status = -1;  // the exit status; beyond 128 the signal that ended the process
  double seconds =
      0;  // of CPU time, which other programs do not lengthen; a process that sleeps runs into ctest's limit
  size_t mostMemory = 0;
};

Ending inspect(const std::filesystem::path& scene, bool lenient) {
  std::string words[] = {WAVECREST_PROGRAM, "inspect", scene.string(), "--threads", "1", "--lenient"};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(),
                       words[3].data(), words[4].data(), lenient ? words[5].data() : nullptr,
                       nullptr};
  posix_spawn_file_actions_t silence;
  posix_spawn_file_actions_init(&silence);
  posix_spawn_file_actions_addopen(&silence, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&silence, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failure = posix_spawn(&child, arguments[0], &silence, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&silence);
  if (failure != 0) return {};
  int state = 0;
  rusage usage{};
  wait4(child, &state, 0, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return {.status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state),
          .seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime),
          .mostMemory = static_cast<size_t>(usage.ru_maxrss) * 1024};
}

TEST(InspectFuzz, DamagedFilesEndInStatus0Or3) {
  const Folder folder;
  writeSeeds(folder);
  const auto [first, last] = casesToRun();
  std::map<int, int> endings;
  double slowest = 0;
  size_t mostMemory = 0;
  for (int i = first; i < last && !HasFailure(); ++i) {
    SCOPED_TRACE("WAVECREST_FUZZ_CASE=" + std::to_string(i));
    const Ending ending = inspect(writeCase(folder, i), isLenient(i));
    EXPECT_TRUE(ending.status == 0 || ending.status == 3) << "status " << ending.status;
    EXPECT_LT(ending.seconds, kSecondsPerCase);
    EXPECT_LT(ending.mostMemory, kMostMemory);
    ++endings[ending.status];
    slowest = std::max(slowest, ending.seconds);
    mostMemory = std::max(mostMemory, ending.mostMemory);
  }
  RecordProperty("cases", last - first);
  RecordProperty("inspected", endings[0]);
  RecordProperty("refused", endings[3]);
  RecordProperty("slowest_ms", static_cast<int>(1e3 * slowest));
  RecordProperty("most_memory_mb", static_cast<int>(mostMemory >> 20));
}

}  // namespace
}  // namespace wavecrest

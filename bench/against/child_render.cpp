#include "bench/against/child_render.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>

#include "bench/ranks/launch.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

// The last non-empty line of a file. In error output the message is there.
std::string lastLine(const fs::path& file) {
  std::ifstream in(file);
  std::string last;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

// This process' environment without the variables that are defaults of options. What is no option is passed on: how
// large images may be, and that each process is on its own, as the child is started by the same launcher.
std::vector<char*> environmentOfChild() {
  std::vector<char*> kept;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable, name = text.substr(0, text.find('='));
    if (!name.starts_with("WAVECREST_") || name == kImageLimitVariable || name == kMpiVariable) {
      kept.push_back(*variable);
    }
  }
  kept.push_back(nullptr);
  return kept;
}

// In the child between fork and exec: only what is safe in a signal handler. It dies with the thread that started it,
// and has a process group of its own, so that what it starts can be ended with it.
[[noreturn]] void becomeProgram(char* const* words, char* const* environment, const char* errors, int failure) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setpgid(0, 0);
  // No input, no output, and errors in the file.
  const int nothing = ::open("/dev/null", O_RDWR), log = ::open(errors, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (nothing >= 0 && log >= 0 && dup2(nothing, STDIN_FILENO) >= 0 && dup2(nothing, STDOUT_FILENO) >= 0 &&
      dup2(log, STDERR_FILENO) >= 0) {
    ::close(nothing);
    ::close(log);
    execve(words[0], words, environment);
  }
  const int error = errno;
  [[maybe_unused]] const ssize_t told = ::write(failure, &error, sizeof error);
  _exit(127);
}

// Starts a program. Throws ChildError where that fails.
pid_t startProgram(const std::vector<std::string>& arguments, const fs::path& errors) {
  // Arguments end with a null pointer. execve does not write to them.
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  const std::vector<char*> environment = environmentOfChild();
  const auto fail = [&](int error) {
    throw ChildError(fmt::format("{}: {}", arguments.front(), std::strerror(error)));
  };
  // The pipe tells why exec failed. Where it did not, the pipe closes without a word.
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) fail(errno);
  const pid_t child = fork();
  if (child == 0) becomeProgram(words.data(), environment.data(), errors.c_str(), ends[1]);
  int error = child < 0 ? errno : 0;
  ::close(ends[1]);
  if (child > 0 && ::read(ends[0], &error, sizeof error) > 0) waitpid(child, nullptr, 0);
  ::close(ends[0]);
  if (error != 0) fail(error);
  return child;
}

// Waits for a child's end; false where the time is over or a signal asks to stop, and the child was ended.
bool waitFor(pid_t child, double patience, int& status) {
  using Seconds = std::chrono::duration<double>;
  const auto begin = std::chrono::steady_clock::now();
  for (auto pause = std::chrono::milliseconds(1);; pause = std::min(2 * pause, std::chrono::milliseconds(20))) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) return true;
    const bool over = Seconds(std::chrono::steady_clock::now() - begin).count() > patience;
    if (over || StopSignals::came() || (ended < 0 && errno != EINTR)) {
      kill(-child, SIGKILL);
      waitpid(child, &status, 0);
      return false;
    }
    std::this_thread::sleep_for(pause);
  }
}

// Runs a program to its end with its error output in a file; the exit code, or 128 + the signal that ended it. Throws
// ChildStopped after a signal, ChildError where it takes more than `patience` seconds.
int runProgram(const std::vector<std::string>& arguments, const fs::path& errors, double patience) {
  const pid_t child = startProgram(arguments, errors);
  int status = 0;
  if (!waitFor(child, patience, status)) {
    if (StopSignals::came()) throw ChildStopped("interrupted; what was running was ended, and nothing was written");
    throw ChildError(
        fmt::format("{}: did not end within {:.0f} s; expected a wavecrest that is not much slower than this",
                    arguments.front(), patience));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ScratchFolder::ScratchFolder() {
  std::string name = (fs::temp_directory_path() / "wavecrest_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw ChildError(fmt::format("{}: {}", name, std::strerror(errno)));
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

nlohmann::json renderInChild(const fs::path& binary, const ChildRequest& request, const ScratchFolder& folder,
                             double patience) {
  const fs::path stats = folder.path() / "stats.json", errors = folder.path() / "errors.txt";
  // The folder may have the statistics of an earlier run.
  fs::remove(stats);
  // The command line.
  std::vector<std::string> arguments = {binary.string(),
                                        "render",
                                        request.scene.string(),
                                        "--method",
                                        request.method,
                                        "--spp",
                                        std::to_string(request.iterations),
                                        "--seed",
                                        std::to_string(request.seed),
                                        "--threads",
                                        std::to_string(request.threads),
                                        "--progress",
                                        "none",
                                        "--stats",
                                        stats.string()};
  if (!request.size.empty()) arguments.insert(arguments.end(), {"--size", request.size});
  const std::string image = request.imageFile.value_or((folder.path() / "image.pfm").string());
  arguments.insert(arguments.end(), {"--output", image});
  arguments.insert(arguments.end(), request.more.begin(), request.more.end());
  // Run the program, and report its last error line if it fails.
  const int code = runProgram(arguments, errors, patience);
  if (code != 0) {
    throw ChildError(fmt::format("{}: render {} --method {} ended with code {}: {}", binary.string(),
                                 request.scene.filename().string(), request.method, code, lastLine(errors)));
  }
  // Read the statistics.
  std::ifstream in(stats);
  nlohmann::json all = nlohmann::json::parse(in, nullptr, false);
  if (!all.is_object() || !all.contains("cpu_seconds")) {
    throw ChildError(fmt::format("{}: its --stats are not those of a wavecrest render", binary.string()));
  }
  return all;
}

double rateOfProcesses(uint32_t count, const ChildRequest& request) {
  std::vector<std::future<double>> rates;
  for (uint32_t i = 0; i < count; ++i) {
    ChildRequest own = request;
    own.seed = i;
    // Each process has a thread that waits for it, and a folder of its own.
    rates.push_back(std::async(std::launch::async, [own = std::move(own)] {
      const ScratchFolder folder;
      return renderInChild(ownBinary(), own, folder).at("paths_per_second").get<double>();
    }));
  }
  double sum = 0;
  for (auto& rate : rates) sum += rate.get();
  return sum;
}

fs::path ownBinary() { return fs::read_symlink("/proc/self/exe"); }

}  // namespace wavecrest

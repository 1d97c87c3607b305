#include "bench/against/child_render.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>

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

// Runs a program to its end with its error output in a file; the exit code, or 128 + the signal that ended it.
int runProgram(const std::vector<std::string>& arguments, const fs::path& errors) {
  // Arguments end with a null pointer. posix_spawn does not write to them.
  std::vector<char*> words;
  words.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  // No input, no output, and errors in the file.
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  // Start the program and wait for its end. A signal may interrupt waitpid.
  pid_t child = 0;
  const int failed = posix_spawn(&child, words.front(), &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw ChildError(fmt::format("{}: {}", arguments.front(), std::strerror(failed)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw ChildError(fmt::format("{}: {}", arguments.front(), std::strerror(errno)));
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

nlohmann::json renderInChild(const fs::path& binary, const ChildRequest& request, const ScratchFolder& folder) {
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
  const int code = runProgram(arguments, errors);
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

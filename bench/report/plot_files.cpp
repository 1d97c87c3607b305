#include "bench/report/plot_files.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <utility>

#include "bench/report/scene_plots.h"
#include "bench/report/series_values.h"
#include "bench/results/within_folder.h"
#include "metrics/image/atomic_file.h"

namespace wavecrest {
namespace {

// Scene names come from files of users: what could lead out of the folder or trouble a shell becomes '_'.
std::string fileName(std::string name) {
  for (char& character : name) {
    const auto c = static_cast<unsigned char>(character);
    if (std::isalnum(c) == 0 && character != '-' && character != '_' && character != '.') character = '_';
  }
  return name;
}

// The name, with a number where an earlier scene has it. Not all file systems tell capitals from small letters.
std::string freeName(const std::string& name, std::set<std::string>& taken) {
  const auto take = [&](std::string candidate) {
    std::transform(candidate.begin(), candidate.end(), candidate.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return taken.insert(std::move(candidate)).second;
  };
  std::string unused = name;
  for (unsigned number = 2; !take(unused); ++number) unused = name + "." + std::to_string(number);
  return unused;
}

}  // namespace

std::vector<std::filesystem::path> writePlotFiles(const ConvergenceReport& report,
                                                  const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> paths;
  const std::string colours = coloursOfOthers(report);
  std::set<std::string> taken;
  for (const ReportScene& scene : report.scenes) {
    const std::string name = freeName(fileName(scene.name), taken);
    for (const ScenePlot& plot : scenePlots(report, scene)) {
      const std::string svg = renderPlotFile(plot.plot, colours);
      paths.push_back(withinFolder(folder, name + "." + fileName(plot.key) + ".svg"));
      writeFileAtomically(paths.back().string(), svg);
    }
  }
  return paths;
}

}  // namespace wavecrest

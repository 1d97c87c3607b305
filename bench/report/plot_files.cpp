#include "bench/report/plot_files.h"

#include <cctype>
#include <string>

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

}  // namespace

std::vector<std::filesystem::path> writePlotFiles(const ConvergenceReport& report,
                                                  const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> paths;
  const std::string colours = coloursOfOthers(report);
  for (const ReportScene& scene : report.scenes) {
    for (const ScenePlot& plot : scenePlots(report, scene)) {
      const std::string svg = renderPlotFile(plot.plot, colours);
      paths.push_back(withinFolder(folder, fileName(scene.name) + "." + fileName(plot.key) + ".svg"));
      writeFileAtomically(paths.back().string(), svg);
    }
  }
  return paths;
}

}  // namespace wavecrest

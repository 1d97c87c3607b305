// wavecrest report DIR: rebuilds DIR/report.html from the images and stats in DIR.
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <string>

#include "bench/report/results_folder.h"
#include "bench/report/write_report.h"
#include "cli/commands.h"
#include "metrics/image/image.h"

namespace wavecrest {

void addReportCommand(CLI::App& app, int& exitCode) {
  CLI::App* command = app.add_subcommand("report", "rebuild DIR/report.html from the results in DIR");
  auto folder = std::make_shared<std::string>();
  command->add_option("DIR", *folder, "folder with images, stats and a reference per scene")->required();
  command->callback([folder, &exitCode] {
    try {
      fmt::print("{}\n", writeReport(std::filesystem::path(*folder)).string());
    } catch (const ResultsError& error) {
      throw InputError(error.what());
    } catch (const ImageError& error) {
      throw InputError(error.what());
    }
    exitCode = kExitDone;
  });
}

}  // namespace wavecrest

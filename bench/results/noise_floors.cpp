#include "bench/results/noise_floors.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace wavecrest {

std::vector<std::string> unmetFloors(const MetricValues& noiseFloors, std::optional<double> bestRelmse) {
  std::vector<std::string> unmet;
  // SSIM has a fixed scale, so its floor has a fixed limit. The scale of relMSE depends on the scene, so its floor is
  // compared with the best run.
  const auto ssim = noiseFloors.find("ssim"), relmse = noiseFloors.find("relmse");
  if (ssim != noiseFloors.end() && ssim->second < kLeastSsimFloor) {
    unmet.push_back(fmt::format("SSIM of a perfect image is {:.4g}, below {:g}", ssim->second, kLeastSsimFloor));
  }
  if (bestRelmse && relmse != noiseFloors.end() && relmse->second > kMostRelmseShare * *bestRelmse) {
    unmet.push_back(fmt::format("relMSE of a perfect image is {:.2g}, above a tenth of the best run's {:.2g}",
                                relmse->second, *bestRelmse));
  }
  return unmet;
}

bool sameFloors(const MetricValues& a, const MetricValues& b) {
  return nlohmann::json(a).dump() == nlohmann::json(b).dump();
}

}  // namespace wavecrest

#include "cli/until_goal.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "metrics/image/image_io.h"

namespace wavecrest {

UntilGoal::UntilGoal(double ssim, const std::string& referenceFile, const FilmArea& film) : ssim_(ssim) {
  if (ssim == 0 || referenceFile.empty()) {
    throw UsageError("--until-ssim and --reference: one without the other; expected both or neither");
  }
  if (std::min(film.width, film.height) < kSsimSmallestSide) {
    throw UsageError(fmt::format("--until-ssim: a film of {}x{} is too small; expected at least {} pixels a side",
                                 film.width, film.height, kSsimSmallestSide));
  }
  ImageFile file = readImage(referenceFile);
  if (file.image.width != film.width || file.image.height != film.height) {
    throw InputError(fmt::format("{}: is {}x{}; expected the render's {}x{}", referenceFile, file.image.width,
                                 file.image.height, film.width, film.height));
  }
  reference_ = std::make_unique<PreparedReference>(referenceFile, std::move(file));
}

nlohmann::ordered_json UntilGoal::render(Session& session, const RenderSettings& settings) const {
  const SsimNow now = renderUntilSsim(session, settings, {.reference = *reference_, .ssim = ssim_});
  return {{"reached", now.reached}, {"iterations", now.iterations}, {"ssim", now.ssim}, {"ssim_goal", ssim_}};
}

std::string UntilGoal::describe(const nlohmann::ordered_json& reached) {
  return fmt::format("{} after {} iterations: SSIM {:.4f}, goal {:.4g}",
                     reached["reached"].get<bool>() ? "reached" : "not reached", reached["iterations"].get<uint64_t>(),
                     reached["ssim"].get<double>(), reached["ssim_goal"].get<double>());
}

}  // namespace wavecrest

#include "cli/until_goal.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/score_text.h"
#include "cli/commands.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

// The reference of --until-ssim. It must have the size of the film, which must be large enough for SSIM.
std::unique_ptr<PreparedReference> readReference(const std::string& name, const FilmArea& film) {
  if (std::min(film.width, film.height) < kSsimSmallestSide) {
    throw UsageError(fmt::format("--until-ssim: a film of {}x{} is too small; expected at least {} pixels a side",
                                 film.width, film.height, kSsimSmallestSide));
  }
  ImageFile file = readImage(name);
  if (file.image.width != film.width || file.image.height != film.height) {
    throw InputError(fmt::format("{}: is {}x{}; expected the render's {}x{}", name, file.image.width, file.image.height,
                                 film.width, film.height));
  }
  return std::make_unique<PreparedReference>(name, std::move(file));
}

// The error and its confidence interval as text. All of the interval has to be at the goal or below. reached: as
// renderUntilError returns it.
std::string describeError(const nlohmann::ordered_json& reached) {
  if (reached["relative_error"].is_null()) return "relative error not known yet";
  const auto goal = reached["relative_error_goal"].get<double>();
  return fmt::format("relative error {:.3g}, {:.3g} to {} with {:.0f} % confidence",
                     reached["relative_error"].get<double>(), reached["interval"][0].get<double>(),
                     scoreBesideTarget(reached["interval"][1].get<double>(), goal, false, 3),
                     100 * reached["interval_level"].get<double>());
}

// The SSIM as text. reached: as UntilGoal::render returns it.
std::string describeSsim(const nlohmann::ordered_json& reached) {
  if (reached["ssim"].is_null()) return "SSIM not known yet";
  const auto goal = reached["ssim_goal"].get<double>();
  return "SSIM " + scoreBesideTarget(reached["ssim"].get<double>(), goal, true, 4, Digits::decimals);
}

}  // namespace

UntilGoal::UntilGoal(const UntilRequest& request, const RenderSettings& settings, const FilmArea& film)
    : request_(request) {
  // Options that do not fit together.
  if ((request.ssim == 0) != request.reference.empty()) {
    throw UsageError("--until-ssim and --reference: one without the other; expected both or neither");
  }
  if (request.ssim > 0 && request.relativeError > 0) {
    throw UsageError("--until-ssim and --until-relative-error: two goals; expected one of them");
  }
  // An SSIM goal needs its reference.
  if (request.ssim > 0) {
    reference_ = readReference(request.reference, film);
    return;
  }
  // An error goal needs independent iterations.
  if (const std::string reason = whyNoFilmError(settings); !reason.empty()) {
    throw UsageError(fmt::format("--until-relative-error: {}; expected another method", reason));
  }
  if (film.size() < kFewestPixelsOfError) {
    throw UsageError(fmt::format(
        "--until-relative-error: a film of {}x{} is too small to tell its error; expected {} pixels or more",
        film.width, film.height, kFewestPixelsOfError));
  }
}

void UntilGoal::reserveMemory(RenderSettings& settings, const FilmArea& film) const {
  if (!settings.memoryBytes || reference_) return;
  const uint64_t bytes = FilmErrorWatch::bytesFor(film.size());
  if (*settings.memoryBytes <= bytes) {
    throw UsageError(
        fmt::format("--memory: the films that --until-relative-error compares take {:.1f} MB; expected more than that",
                    static_cast<double>(bytes) / 1e6));
  }
  *settings.memoryBytes -= bytes;
}

nlohmann::ordered_json UntilGoal::render(Session& session, const RenderSettings& settings) {
  // Only an SSIM goal has a reference.
  if (!reference_) return renderUntilError(session, settings);
  const SsimNow now = renderUntilSsim(session, settings, {.reference = *reference_, .ssim = request_.ssim});
  reached_ = now.reached;
  return {{"reached", now.reached},
          {"iterations", now.iterations},
          {"ssim", now.ssim ? nlohmann::ordered_json(*now.ssim) : nlohmann::ordered_json()},
          {"ssim_goal", request_.ssim}};
}

nlohmann::ordered_json UntilGoal::renderUntilError(Session& session, const RenderSettings& settings) {
  // An error that is not known yet is null.
  using Value = nlohmann::ordered_json;
  const ErrorNow now = error_.renderUntil(session, settings, request_.relativeError);
  reached_ = now.reached;
  black_ = now.black;
  return {{"reached", now.reached},
          {"iterations", now.iterations},
          {"relative_error", now.error ? Value(now.error->value) : Value()},
          {"interval", now.error ? Value({now.error->interval.low, now.error->interval.high}) : Value()},
          {"interval_level", kIntervalLevel},
          {"relative_error_goal", request_.relativeError}};
}

std::string UntilGoal::describe(const nlohmann::ordered_json& reached) {
  const bool ofSsim = reached.contains("ssim");
  return fmt::format("{} after {} iterations: {}, goal {}", reached["reached"].get<bool>() ? "reached" : "not reached",
                     reached["iterations"].get<uint64_t>(), ofSsim ? describeSsim(reached) : describeError(reached),
                     reached[ofSsim ? "ssim_goal" : "relative_error_goal"].get<double>());
}

}  // namespace wavecrest

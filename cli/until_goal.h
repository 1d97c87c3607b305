// `render --until-ssim S --reference R` and `--until-relative-error E`: the goal as the command line gives it, checked
// before the render.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/until/until.h"

namespace wavecrest {

struct UntilRequest {
  double ssim = 0, relativeError = 0;  // 0: not asked for
  std::string reference;

  bool any() const { return ssim > 0 || relativeError > 0 || !reference.empty(); }
};

class UntilGoal {
 public:
  // Throws UsageError where options do not fit together, ImageError for a reference that cannot be read, InputError for
  // one of another size than the film's.
  UntilGoal(const UntilRequest& request, const RenderSettings& settings, const FilmArea& film);
  // Takes the memory of an error goal off the budget. Throws UsageError where nothing is left.
  void reserveMemory(RenderSettings& settings, const FilmArea& film) const;

  // Renders to the goal, to the settings' end or to an interrupt. Returns what was reached, for stats. May be called
  // again for the same session.
  nlohmann::ordered_json render(Session& session, const RenderSettings& settings);
  // Whether the goal is reached, or never will be.
  bool over() const { return reached_ || black_; }
  // Whether the film was found black, which has no error.
  bool black() const { return black_; }
  // What was reached in one line.
  static std::string describe(const nlohmann::ordered_json& reached);

 private:
  nlohmann::ordered_json renderUntilError(Session& session, const RenderSettings& settings);

  UntilRequest request_;
  std::unique_ptr<PreparedReference> reference_;
  FilmErrorWatch error_;
  bool reached_ = false, black_ = false;
};

}  // namespace wavecrest

// `render --until-ssim S --reference R`: the goal as the command line gives it, checked before the render.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/until/until.h"

namespace wavecrest {

class UntilGoal {
 public:
  // Throws UsageError where options do not fit together, ImageError for a reference that cannot be read, InputError for
  // one of another size than the film's.
  UntilGoal(double ssim, const std::string& referenceFile, const FilmArea& film);

  // Renders to the goal, to the settings' end or to an interrupt. Returns what was reached, for stats.
  nlohmann::ordered_json render(Session& session, const RenderSettings& settings) const;
  // The same in one line.
  static std::string describe(const nlohmann::ordered_json& reached);

 private:
  double ssim_;
  std::unique_ptr<PreparedReference> reference_;
};

}  // namespace wavecrest

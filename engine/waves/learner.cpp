#include "engine/waves/learner.h"

#include <algorithm>
#include <bit>

#include "engine/pilot/view_walk.h"
#include "engine/scene/vector_math.h"

namespace wavecrest {
namespace {

// So many paths of a block are enough: some millions of records, thousands for each cell. A power of two, so that waves
// of several iterations fit.
constexpr uint64_t kPathsOfBlock = uint64_t{1} << 20;

constexpr uint64_t kPathsOfLook = 64;

// The cell of the first vertex with more than delta lobes of a camera path through a pixel (y << 16 | x): of the first
// of some paths that has one, as others may leave the scene.
template <class S>
std::optional<uint32_t> cellSeen(const RenderPlan<S>& plan, const RenderSettings& settings, const CellTreeView& cells,
                                 uint32_t pixel) {
  std::optional<uint32_t> cell;
  const ViewLook<S> look = [&](Wave<S>& wave, uint32_t depth) {
    if (depth != 0 && wave.joinable != 0) cell = wave.cells.cell[0];
    return !cell;
  };
  for (uint64_t path = 0; path < kPathsOfLook && !cell; ++path) {
    walkViews<S>(plan, settings, {&pixel, 1}, settings.seed + path, &cells, look, nullptr);
  }
  return cell;
}

std::vector<float> luminanceInWaveOrder(const Film& film) {
  const FilmArea& area = film.area();
  const std::vector<float> image = film.resolve();
  std::vector<float> luminances;
  luminances.reserve(area.pixels.size());
  for (const uint32_t pixel : area.pixels) {
    const size_t x = (pixel & 0xffff) - area.x0, y = (pixel >> 16) - area.y0;
    const float* const rgb = &image[3 * (y * area.width + x)];
    luminances.push_back(static_cast<float>(luminance({rgb[0], rgb[1], rgb[2]})));
  }
  return luminances;
}

}  // namespace

template <class S>
Learner<S>::Learner(const RenderPlan<S>& plan, const RenderSettings& settings, size_t pixels)
    : gathering_(std::bit_floor(std::max<uint64_t>(kPathsOfBlock / std::max<size_t>(pixels, 1), 1))) {
  const SceneView<S>& scene = plan.view;
  if (plan.pipeline.has(Fold::guide)) {
    guide_.emplace(scene.center, scene.halfExtent, settings.guide, settings.guideBytes, plan.typicalBrightness);
    if (settings.roulette == Roulette::efficiency) worth_.emplace(pixels);
    updateView();
  }
}

template <class S>
void Learner<S>::prepare(StageContext<S>& context, uint64_t iteration) const {
  context.learned.cells = &guide_->cellTree();
  context.learned.guide = &view_;
  context.learned.records = gathers(iteration, gathering_);
}

template <class S>
void Learner<S>::gather(const Wave<S>& wave, uint64_t iteration) {
  if (!guide_ || !gathers(iteration, gathering_)) return;
  guide_->gather(wave.directions, wave.radiance);
  if (worth_) worth_->gather(wave.directions);
}

template <class S>
void Learner<S>::updateView() {
  view_ = guide_->view();
  if (worth_) worth_->showIn(view_);
}

template <class S>
void Learner<S>::fold(const Film& film) {
  guide_->fold();
  if (worth_) worth_->fold(luminanceInWaveOrder(film));
  updateView();
  blockEnd_ = endOfBlock(blockEnd_);
}

template <class S>
std::optional<GuideStatistics> Learner<S>::guideStatistics() const {
  return guide_ ? std::optional(guide_->statistics()) : std::nullopt;
}

template <class S>
std::optional<LearnedDirections> Learner<S>::learnedDirections(const RenderPlan<S>& plan,
                                                               const RenderSettings& settings, uint32_t x,
                                                               uint32_t y) const {
  if (!guide_) return std::nullopt;
  const std::optional<uint32_t> cell = cellSeen(plan, settings, guide_->cellTree(), y << 16 | x);
  return cell ? std::optional(guide_->learnedIn(*cell)) : std::nullopt;
}

template <class S>
void Learner<S>::save(StateWriter& out) const {
  if (!learns()) return;
  out.value(blockEnd_);
  guide_->save(out);
  if (worth_) worth_->save(out);
}

template <class S>
void Learner<S>::restore(StateReader& in) {
  if (!learns()) return;
  blockEnd_ = in.value<uint64_t>();
  if (!std::has_single_bit(blockEnd_)) throw StateError("its blocks of iterations are others");
  guide_->restore(in);
  if (worth_) worth_->restore(in);
  updateView();
}

template class Learner<float>;
template class Learner<double>;

}  // namespace wavecrest

#include "engine/plan/chain_layout.h"

#include <algorithm>

#include "engine/plan/render_plan.h"

namespace wavecrest {
namespace {

constexpr uint32_t bit(Block block) { return 1u << static_cast<uint32_t>(block); }

size_t groupSizeFor(const RenderSettings& settings) {
  constexpr size_t kFewWaves = 8;  // of a thread
  const uint32_t threads = settings.cutForThreads();
  const bool few = piecesOf(settings.chainsOfShare(), settings.waveSize) < kFewWaves * threads;
  return threads > 1 && few ? std::min<size_t>(kColumnPadding, settings.waveSize) : settings.waveSize;
}

}  // namespace

ChainLayout::ChainLayout(const RenderSettings& settings)
    : part_(settings.share.part),
      parts_(settings.share.parts),
      chains_(settings.chainsOfShare()),
      groupSize_(groupSizeFor(settings)),
      groups_(piecesOf(chains_, groupSize_)),
      waves_(piecesOf(groups_, settings.waveSize / groupSize_)) {}

size_t ChainLayout::chainsOfGroup(size_t group) const { return itemsOfPiece(group, chains_, groupSize_); }

size_t ChainLayout::chainsOf(size_t wave) const {
  const size_t ofWave = piecesOf(groups_ - wave, waves_), last = wave + (ofWave - 1) * waves_;
  return (ofWave - 1) * groupSize_ + chainsOfGroup(last);
}

template <class S>
ChainState::Kept keptSamples(const Pipeline<S>& pipeline, const SceneView<S>& scene, uint32_t maxDepth) {
  const uint32_t sky = scene.environment.width != 0 ? bit(Block::environment) : 0u;
  ChainState::Kept kept;
  if (pipeline.inPathSpace) {  // numbers are drawn for all that walks do, and none is kept
    kept.blocks[0] = kept.blocks[1] = {0xfu, 0xfu};
    return kept;
  }
  if (!pipeline.lightPass()) {
    kept.blocks[0] = {bit(Block::scatter), bit(Block::scatter) | bit(Block::light) | sky};
    kept.vertices[0] = maxDepth;  // the last vertex, which draws nothing, does not count
    return kept;
  }
  // One next event at most, whose numbers are those of vertex 0 whatever the path's length.
  kept.blocks[0] = {bit(Block::scatter) | bit(Block::light) | bit(Block::opacity) | sky, bit(Block::scatter)};
  kept.blocks[1] = {bit(Block::scatter) | bit(Block::light) | sky, bit(Block::scatter)};
  kept.vertices[0] = kept.vertices[1] = maxDepth;
  return kept;
}

template ChainState::Kept keptSamples(const Pipeline<float>&, const SceneView<float>&, uint32_t);
template ChainState::Kept keptSamples(const Pipeline<double>&, const SceneView<double>&, uint32_t);

}  // namespace wavecrest

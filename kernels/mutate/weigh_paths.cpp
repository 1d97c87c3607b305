// weighPaths, commitPaths: the ratio by which proposed paths are accepted, and what accepted paths leave behind.
//
// weighPaths: in: the lanes whose proposals are whole, rows of both paths. out: Radiance and Chains::scale such that
// the luminance of their product over Chains::target is the ratio f(y) T(y -> x) / (f(x) T(x -> y)) of METHODS 7.6; of
// a chain without a path f(y) / T(y). Pixels of the proposals, and which perturbations suit them. commitPaths: in:
// Chains::rejections after acceptMutations. out: the current paths, replaced where accepted.
//
// Everything is relative to the density q of an eye walk that chooses x_0 on the light by itself: f / q is a product of
// steps of the size of albedos, and the density of a path made with s light vertices is q times light / eye of these.
#include "kernels/mutate/path_lanes.h"
#include "kernels/mutate/path_law_lanes.h"
#include "kernels/mutate/path_pattern.h"
#include "kernels/sampling/chain_lanes.h"
#include "kernels/stage_declarations.h"

WAVECREST_SIMD_BEGIN

namespace {

// A block of paths, current or proposed, all of their lanes at once.
template <class S>
class PathBlock {
 public:
  WAVECREST_INLINE PathBlock(const PathStore<S>& store, UInt lane, Mask m)
      : v_(store.vertices),
        rowStride_(store.stride()),
        stride_(static_cast<uint32_t>(store.stride())),
        lane_(lane),
        edges(select(m, gather(store.headers.edges, lane), UInt(1u))),
        lightR_(gather(store.headers.lightR, lane)),
        lightG_(gather(store.headers.lightG, lane)),
        lightB_(gather(store.headers.lightB, lane)) {}

  // f / q: the product of steps; of a light in view its radiance, made by the lens alone.
  WAVECREST_INLINE auto overReference(Mask m) const {
    using Real = decltype(lightR_);
    const UInt one(1u);
    Vec3<Real> product{Real(1), Real(1), Real(1)};
    for (UInt row = one;; row = row + one) {
      const Mask counts = m & (row < edges);
      if (none(counts)) break;
      const UInt at = select(counts, row, one) * stride_ + lane_;
      product = select(counts, product * gatherVec3(v_.stepR, v_.stepG, v_.stepB, at), product);
    }
    const Mask seen = m & (edges == one);
    const Vec3<Real> light = Vec3<Real>{lightR_, lightG_, lightB_} * (gather(v_.eye, lane_) / gather(v_.light, lane_));
    return select(seen, light, product);
  }

  // The sum over all splits of the density of rows [kept, end) over that part of q.
  WAVECREST_INLINE Double splitSum(Mask m, UInt kept, UInt end) const {
    const UInt zero(0u), one(1u);
    const UInt splits = splitsOf(end - kept, edges < end, edges);
    Double sum(0.0), product(1.0);
    const Mask noLight = kept == zero;
    for (UInt s = zero;; s = s + one) {
      const Mask counts = m & (s < splits);
      if (none(counts)) break;
      const UInt row = select(counts, kept + s, one);  // the first of the eye's side
      const Mask walked = counts & (zero < s);
      product = select(walked & (one < row), product * ratio(select(walked, row - one, one)), product);
      const Mask chance = counts & noLight & (s == zero);
      const Double met = to<Double>(gather(v_.eye, lane_)) / to<Double>(gather(v_.light, lane_));
      const Mask joint = counts & joins(select(chance, one, row) - one) & joins(row);
      sum = sum + select(chance, met, zeroUnless(joint, product));
    }
    return sum;
  }

  // The part of q that rows below `kept` owe to their new neighbours.
  WAVECREST_INLINE Double keptDensity(Mask m, UInt kept) const {
    const UInt one(1u), two(2u);
    Double product(1.0);
    for (const UInt below : {one, two}) {
      const Mask counts = m & (below < kept);
      const UInt row = select(counts, kept - below, one);
      product = select(counts, product * to<Double>(gather(v_.eye, row * stride_ + lane_)), product);
    }
    return product;
  }

  // Densities of directions that a perturbation from the eye down to row `end` does not choose: q over its own density,
  // but for the angles' and the raster's, which are the same there and back.
  WAVECREST_INLINE Double eyeChoices(Mask m, UInt end) const {
    const UInt zero(0u), one(1u);
    Double product(1.0);
    for (UInt row = end + one;; row = row + one) {
      const Mask counts = m & (row < edges);
      if (none(counts)) break;
      const UInt at = select(counts, row, one) * stride_ + lane_;
      product = select(counts, product * to<Double>(gather(v_.eyeChoice, at)), product);
    }
    const Double met = to<Double>(gather(v_.light, lane_)) / to<Double>(gather(v_.eye, lane_));
    return select(m & (end == zero), product * met, product);
  }

  // The same of a caustic perturbation from row `start` on.
  WAVECREST_INLINE Double lightChoices(Mask m, UInt start) const {
    const UInt one(1u);
    Double product(1.0);
    for (UInt row = start;; row = row + one) {
      const Mask counts = m & (row < edges);
      if (none(counts)) break;
      const UInt r = select(counts, row, one), at = r * stride_ + lane_;
      const Double choice = to<Double>(gather(v_.lightChoice, at - stride_)) / ratio(r);
      product = select(counts, product * choice, product);
    }
    return product;
  }

  template <class Real>
  WAVECREST_INLINE CausticRange<Real> angles(const StageContext<S>& context, Mask m, UInt start) const {
    return causticRange<Real>(context, v_, rowStride_, edges, start, m, lane_);
  }

 private:
  WAVECREST_INLINE Double ratio(UInt row) const {
    const UInt at = row * stride_ + lane_;
    return to<Double>(gather(v_.light, at)) / to<Double>(gather(v_.eye, at));
  }
  // Whether a walk may end at a row: on the light, on the lens, or where no delta lobe joins its edges.
  WAVECREST_INLINE Mask joins(UInt row) const {
    const UInt zero(0u);
    const UInt event = gather(v_.event, select(row < edges, row, zero) * stride_ + lane_);
    return (row == zero) | (row == edges) | (event == zero);
  }

  const PathVertices<S>& v_;
  size_t rowStride_;
  UInt stride_, lane_;

 public:
  UInt edges;

 private:
  decltype(gather(v_.eye, lane_)) lightR_, lightG_, lightB_;
};

// f / T of `path` as the proposal that replaces rows [kept, other's eyeFrom) of `from` by its rows [kept, end), without
// f / q: what T leaves of q.
template <class Real, class S>
WAVECREST_NOINLINE Double restOfReference(const StageContext<S>& context, const PathBlock<S>& path, UInt end,
                                          const PathBlock<S>& from, UInt fromEnd, UInt fromKinds, Mask m, UInt kind,
                                          UInt kept, Real angle) {
  const PathLaw& law = *context.chains.paths->law;
  const Mask large = m & (kind == mutationCode(Mutation::large));
  const Mask replaces = m & (kind == mutationCode(Mutation::bidirectional));
  const Mask fromEye = m & ((kind == mutationCode(Mutation::lens)) | (kind == mutationCode(Mutation::multiChain)));
  const Mask caustic = m & (kind == mutationCode(Mutation::caustic));
  Double rest = path.keptDensity(m, kept);
  if (any(large | replaces)) {
    const Double sum = path.splitSum(large | replaces, kept, end);
    Float share(1);
    if (any(large)) {
      const Float splits = toFloat(splitsOf(end, path.edges < end, path.edges));
      share = lengthShare(law, select(large, path.edges, UInt(law.minEdges))) / splits;
    }
    const UInt two(2u);
    if (any(replaces)) {
      const UInt edges = select(replaces, from.edges, two);
      share = select(replaces,
                     bidirectionalShare(law, edges, select(replaces, kept, UInt(0u)),
                                        select(replaces, fromEnd, UInt(1u)), select(replaces, end - kept, UInt(1u))),
                     share);
    }
    const Double density = sum * to<Double>(share);
    const Mask possible = (large | replaces) & (density > Double(0.0));
    rest = select(large | replaces, zeroUnless(possible, rest / select(possible, density, Double(1.0))), rest);
  }
  if (any(fromEye)) rest = select(fromEye, rest * path.eyeChoices(fromEye, kept), rest);
  if (any(caustic)) {
    const auto range = from.template angles<Real>(context, caustic, kept);
    // Rounding must not forbid the angle that was chosen at the end of its own range.
    const Real reach = range.smallest * exp(range.logRatio);
    const Mask within = (angle >= range.smallest * Real(0.99999f)) & (angle <= reach * Real(1.00001f));
    const Double turned = rest * path.lightChoices(caustic, kept) * to<Double>(range.logRatio);
    rest = select(caustic, zeroUnless(within, turned), rest);
  }
  return select(large, rest, rest * to<Double>(toFloat(fromKinds)));
}

// What suits the proposals, one by one: loops over events end after a few rows.
template <class S>
WAVECREST_INLINE void findPatterns(const StageContext<S>& context) {
  PathMutations<S>& paths = *context.chains.paths;
  const auto& v = paths.proposed.vertices;
  const auto& headers = paths.proposed.headers;
  for (size_t i = 0; i < paths.laneCount; ++i) {
    const uint32_t lane = paths.lanes[i];
    const auto kind = static_cast<LightKind>(context.scene->lights[v.primitive[lane]].kind);
    const bool infinite = kind == LightKind::directional || kind == LightKind::constant || kind == LightKind::envmap;
    const PathPattern pattern = pathPattern(v.event + lane, paths.proposed.stride(), headers.edges[lane], !infinite);
    headers.eyeEnd[lane] = pattern.eyeEnd;
    headers.multiChain[lane] = pattern.multiChain ? 1 : 0;
    headers.causticStart[lane] = pattern.causticStart;
  }
}

// The pixel of the rendered rectangle that a path belongs to. A filter spreads a path over several; a chain's state is
// a path and one of them, which every proposal draws anew by their shares. Paths that draw a pixel beyond the rectangle
// are dark.
struct ProposedPixel {
  UInt index;
  Mask onFilm;
};
template <class S>
WAVECREST_INLINE ProposedPixel choosePixel(const StageContext<S>& context, UInt lane, Float rasterX, Float rasterY) {
  const CameraView& camera = context.scene->camera;
  const FilmWindow& film = context.film;
  Float u(0), v(0);
  if (camera.filter != FilterKind::box) {
    const UInt source = gather(context.chains.state->columns.source, lane);
    const ChainNumbers bits = chainBits(context.sampler, source, kPixelBlock, ChainUse::step);
    u = toUnitInterval(bits.a);
    v = toUnitInterval(bits.b);
  }
  const Float width(static_cast<float>(film.width)), height(static_cast<float>(film.height)), zero(0);
  const Float x = splatPixel(camera, rasterX, u).pixel - Float(static_cast<float>(film.x0)),
              y = splatPixel(camera, rasterY, v).pixel - Float(static_cast<float>(film.y0));
  const Mask onFilm = (x >= zero) & (y >= zero) & (x < width) & (y < height);
  return {toUInt(zeroUnless(onFilm, y)) * UInt(film.width) + toUInt(zeroUnless(onFilm, x)), onFilm};
}

// The same for every feature set, so there is one for each storage type.
template <class Real, class S>
WAVECREST_NOINLINE void weighWave(const StageContext<S>& context, Wave<S>& wave) {
  PathMutations<S>& paths = *context.chains.paths;
  const PathPlans& plans = paths.plans;
  const Chains& chains = context.chains.state->columns;
  findPatterns(context);
  for (size_t i = 0; i < paths.laneCount; i += kLanes) {
    const Mask active = firstLanes(paths.laneCount - i);
    const UInt lane = load(paths.lanes, i);
    const UInt kind = gather(plans.kind, lane), kept = gather(plans.lightKept, lane);
    const UInt end = gather(plans.eyeTo, lane), fromEnd = gather(plans.eyeFrom, lane);
    const auto& headers = paths.proposed.headers;
    const PathBlock<S> proposed(paths.proposed, lane, active);
    const Float rasterX = gather(headers.rasterX, lane), rasterY = gather(headers.rasterY, lane);
    // The proposal's contribution to the film over its reference density.
    const Vec3<Real> value = proposed.overReference(active) * filmWeight<Real>(context, rasterX, rasterY);
    const Real luminance = luminanceOf(value);
    const ProposedPixel pixel = choosePixel(context, lane, rasterX, rasterY);
    const Mask lit = active & pixel.onFilm & (luminance > Real(0)) & (luminance < Real(1e30f));

    // ratio: f(y) T(y -> x) / (f(x) T(x -> y)), or the target of a chain that is nowhere yet.
    Double ratio(0.0);
    const Mask somewhere = active & (gather(chains.target, lane) > Float(0));
    if (any(andNot(active, somewhere))) {
      // A bootstrap's lengths are given, so their probabilities are no part of the estimate.
      const Double sum = proposed.splitSum(lit, UInt(0u), end);
      const Double splits = to<Double>(toFloat(splitsOf(end, allLanes(), proposed.edges)));
      const Mask possible = lit & (sum > Double(0.0));
      ratio = zeroUnless(possible, to<Double>(luminance) * splits / select(possible, sum, Double(1.0)));
    }
    if (any(somewhere)) {
      // Probabilities to propose y from x and x from y, over the same reference density.
      const Real angle = to<Real>(gather(plans.angle, lane));
      const PathBlock<S> current(*paths.current, lane, somewhere);
      const auto& from = paths.current->headers;
      const PathLaw& law = *paths.law;
      const UInt kindsHere = suitableKinds(law, current.edges, gather(from.causticStart, lane)).count;
      const UInt kindsThere = suitableKinds(law, proposed.edges, gather(headers.causticStart, lane)).count;
      const Double forth =
          restOfReference<Real>(context, proposed, end, current, fromEnd, kindsHere, lit, kind, kept, angle);
      const Double back =
          restOfReference<Real>(context, current, fromEnd, proposed, end, kindsThere, lit, kind, kept, angle);
      const Real weight = filmWeight<Real>(context, gather(from.rasterX, lane), gather(from.rasterY, lane));
      const Double here = to<Double>(luminanceOf(current.overReference(somewhere)) * weight) * back;
      const Mask possible = lit & (here > Double(0.0)) & (forth > Double(0.0)) & (forth < Double(1e200));
      const Mask large = lit & (kind == mutationCode(Mutation::large));
      storeWhere(to<Float>(to<Double>(luminance) * forth), large, chains.estimate, lane);
      const Double quotient = to<Double>(luminance) * forth / select(possible, here, Double(1.0));
      ratio = select(somewhere, zeroUnless(possible, min(quotient, Double(1e30))), ratio);
      storeWhere(Float(1), somewhere, chains.target, lane);
    }
    // What the film gets: the colour at the proposed pixel, scaled so that its luminance is the ratio. NaN and
    // infinity are passed on, so that acceptMutations counts them.
    const Mask number = luminance - luminance == Real(0);
    const Vec3<Real> colour = select(andNot(active & pixel.onFilm, number), value, zeroUnless(lit, value));
    storeWhere(colour, active, wave.radiance.red, wave.radiance.green, wave.radiance.blue, lane);
    // Within the range of a float, so that a very dim path can replace one that is dimmer by far.
    const Double scale = min(ratio / to<Double>(select(lit, luminance, Real(1))), Double(3e38));
    storeWhere(to<Float>(scale), active, chains.scale, lane);
    storeWhere(pixel.index, active, chains.proposedPixel, lane);
  }
}

template <class S>
WAVECREST_NOINLINE void commitWave(const StageContext<S>& context, const Wave<S>& wave) {
  PathMutations<S>& paths = *context.chains.paths;
  if (paths.current == nullptr) return;
  const UInt zero(0u);
  const size_t count = wave.pathCount, stride = paths.proposed.stride();
  for (size_t i = 0; i < count; i += kLanes) {
    const Mask accepted = firstLanes(count - i) & (load(context.chains.state->columns.rejections, i) == zero);
    if (none(accepted)) continue;
    const UInt edges = load(paths.proposed.headers.edges, i);
    const auto replace = [&](size_t at, Mask m) WAVECREST_LAMBDA {
      return [&, at, m](const auto& to, const auto& from)
                 WAVECREST_LAMBDA { store(select(m, load(from, at), load(to, at)), to, at); };
    };
    forEachColumn(paths.current->headers, paths.proposed.headers, replace(i, accepted));
    for (uint32_t row = 0;; ++row) {
      const Mask m = andNot(accepted, edges < UInt(row));
      if (none(m)) break;
      forEachColumn(paths.current->vertices, paths.proposed.vertices, replace(row * stride + i, m));
    }
  }
}

}  // namespace

template <class P>
void weighPaths(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  weighWave<typename P::Real>(context, wave);
}

template <class P>
void commitPaths(const StageContext<typename P::Storage>& context, Wave<typename P::Storage>& wave) {
  commitWave(context, wave);
}

WAVECREST_SIMD_END

WAVECREST_INSTANTIATE_COMMON_STAGE(weighPaths)
WAVECREST_INSTANTIATE_COMMON_STAGE(commitPaths)

// The guide at each lane's vertex: directions drawn from it, and the density that paths go on with. Every stage that
// draws or weighs directions asks here (METHODS 12.1).
#pragma once

#include "kernels/guide/square_lanes.h"
#include "kernels/lane_support.h"

WAVECREST_SIMD_BEGIN

// The guide of the vertices [i, i + kLanes). share: 1 where a vertex has delta lobes alone or its cell no histogram.
struct GuideLanes {
  UInt cell;
  Float share;
  template <class S>
  WAVECREST_INLINE GuideLanes(const GuideView& guide, const Wave<S>& wave, Mask active, size_t i)
      : cell(select(active, load(wave.cells.cell, i), UInt(0u))), share(1) {
    const Mask joinable = active & firstLanes(wave.joinable - std::min(i, wave.joinable));
    share = select(joinable, gather(guide.share, cell), Float(1));
  }
  WAVECREST_INLINE Mask draws() const { return share < Float(1); }
};

// Per solid angle.
WAVECREST_INLINE Float guideDensity(const GuideView& guide, UInt cell, Vec3<Float> direction) {
  const SquarePoint at = toSquare(direction);
  const UInt bin = gather(guide.bins, shiftLeft<kGuideBinBits>(cell) + binOf(at.u, at.v));
  return toFloat(shiftRight<GuideBin::kUnitShift>(bin)) * Float(kGuideDensityOfUnit) / at.solidAngle;
}

// A direction by the guide of each lane's cell. u.b chooses the bin, u.c and u.d the place in it.
WAVECREST_INLINE Vec3<Float> drawFromGuide(const GuideView& guide, UInt cell, const Uniform4& u) {
  const UInt inColumn((1u << kGuideColumnBits) - 1);
  const UInt number = toUInt(u.b * Float(static_cast<float>(1u << kGuideUnitBits)));
  const UInt column = shiftRight<kGuideColumnBits>(number), unit = number & inColumn;
  const UInt entry = gather(guide.bins, shiftLeft<kGuideBinBits>(cell) + column);
  const UInt own = shiftRight<GuideBin::kOwnShift>(entry) & inColumn;
  const UInt bin = select(unit < own, column, entry & UInt(kGuideBins - 1));
  constexpr float kWidth = 2.0f / kGuideSide;
  const Float left = toFloat(bin & UInt(kGuideSide - 1)), low = toFloat(shiftRight<kGuideSideBits>(bin));
  Float solidAngle;
  return fromSquare(mulAdd(left + u.c, Float(kWidth), Float(-1)), mulAdd(low + u.d, Float(kWidth), Float(-1)),
                    solidAngle);
}

// The density of a direction that is not of a delta lobe, of paths that go on from the vertices [i, i + kLanes); pdf:
// the BSDF's own.
template <class Real, class S>
WAVECREST_NOINLINE Real mixedPdf(const StageContext<S>& context, const Wave<S>& wave, Mask active, size_t i,
                                 Vec3<Real> direction, Real pdf) {
  const GuideLanes at(*context.learned.guide, wave, active, i);
  if (none(active & at.draws())) return pdf;
  const Real guided = to<Real>(guideDensity(*context.learned.guide, at.cell, to<Float>(direction)));
  const Real share = to<Real>(at.share);
  return select(at.draws(), share * pdf + (Real(1) - share) * guided, pdf);
}

WAVECREST_SIMD_END

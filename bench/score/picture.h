// What `bench --score` compares where bits may differ: the image reduced to 64x48 pixels in 8-bit sRGB, and the mean
// radiance of its blocks.
//
// Both images have the same seed. Rounding changes few paths, so an image by another instruction set or compiler has
// nearly the same noise. Another seed, sampler or estimator has other noise and is refused, even if its mean is right.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/methods/method_list.h"
#include "metrics/image/image.h"

namespace wavecrest {

constexpr uint32_t kPictureWidth = 64, kPictureHeight = 48;

// The image on `width` columns, each pixel the mean of the film's within it; the film itself where it is no wider.
// The sides of the film are multiples of those of the result.
Image reduced(const Image& film, uint32_t width);

struct ScorePicture {
  Image8 codes;                   // kPictureWidth x kPictureHeight, sRGB
  std::vector<float> blockMeans;  // of R + G + B, linear; of PixelBlocks, row by row
};

// film: linear RGB; its sides are multiples of the picture's.
ScorePicture pictureOf(const Image& film);

// How far a picture is from the expected one. A difference that is not finite is beyond every tolerance.
struct PictureDifference {
  double ssim = 1, worstBlockSsim = 1;        // of the sRGB pixels: mean over the picture and over its worst block
  double meanOff = 0, worstBlockMeanOff = 0;  // of linear means: absolute difference over the expected mean
};

PictureDifference differenceOf(const ScorePicture& own, const ScorePicture& expected);

// Limits of a difference. Measured with the small workload against AVX-512: rounding is the worst entry of SSE4, AVX2,
// scalar code and double precision; another seed is the entry that differs least, of two seeds; so is the image x 1.02.
//
//                                        rounding   another seed   x 1.02   limit
//     SSIM of the image                    0.9986         0.9913   0.9990   0.995
//     SSIM of the worst block              0.9654         0.9597   0.9973   0.92
//     mean of the image off by             0.04 %        0.007 %      2 %   0.3 %
//     mean of the worst block off by        2.3 %          1.2 %      2 %   6 %
//     the same of mlt                      0.9848         0.9569   0.9990   0.97
//                                          0.9043         0.8108   0.9983   0.85
//                                          0.01 %          0.1 %      2 %   0.3 %
//                                           6.0 %          4.9 %      2 %   15 %
//
// SSIM of the image refuses other noise, its mean another brightness. Blocks refuse local errors. If rounding makes a
// chain of mlt accept another proposal, all its later states differ: hence wider limits.
struct PictureTolerance {
  double ssim, worstBlockSsim, meanOff, worstBlockMeanOff;
};
PictureTolerance toleranceOf(Method method);

bool isWithin(const PictureDifference& difference, const PictureTolerance& tolerance);

// "worst block: SSIM 0.9867, mean off by 2.1 %; image: SSIM 0.9990, mean off by 0.03 %"
std::string toText(const PictureDifference& difference);
// What is beyond the tolerance: "image: mean off by 2 %, at most 0.3 %"; empty if nothing is.
std::string whatExceeds(const PictureDifference& difference, const PictureTolerance& tolerance);

}  // namespace wavecrest

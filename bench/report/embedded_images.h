// The images of a page, put into the page itself as data URIs: a report must open offline from one file.
//
// A campaign of many scenes and methods has more pixels than a page should weigh. So all images of a page are written
// alike, in the best of a list of codings that stays within a budget: PNG while that fits, then JPEG of falling
// quality, then smaller pictures. The page says which.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bench/report/image_coding.h"
#include "bench/report/report_data.h"

namespace wavecrest {

/// RFC 4648 base64 with padding.
std::string base64(std::span<const uint8_t> bytes);

class EmbeddedImages {
 public:
  /// No image at all: every URI is empty. For measuring what the rest of a page weighs.
  EmbeddedImages() = default;

  /// The images of a report within a number of characters, or as the smallest coding makes them. Keeps pointers into
  /// the report. Errors as encodeImage.
  EmbeddedImages(const ConvergenceReport& report, size_t budget);

  /// "data:image/png;base64,...", of an image of that report.
  const std::string& uri(const ReportImage& image) const;

  const ImageCoding& coding() const { return coding_; }

  /// One sentence for the reader; empty if every pixel is as it was rendered.
  std::string remark() const;

 private:
  bool encodeAll(const std::vector<const ReportImage*>& images, const ImageCoding& coding, size_t budget);

  std::map<const ReportImage*, std::string> uris_;
  ImageCoding coding_;
};

}  // namespace wavecrest

// The markup of an image viewer, which report.js makes interactive: groups of panes on show one at a time, pictures
// first. Panes of one name in several groups belong together; the first pane of the first group is the reference.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "bench/report/picture_crop.h"

namespace wavecrest {

struct ViewerPane {
  std::string name;   ///< on its button
  std::string label;  ///< below it
  std::string_view uri;
  uint32_t width = 0, height = 0;
  std::string floats = {};  ///< where its floats are, "#ID" or a script beside the page; empty: there are none
};
std::string viewerPane(const ViewerPane& pane);

/// A group of panes; kind: plain text on its button; head: HTML above the panes, or nothing. step: of pictures at an
/// earlier time, which a slider chooses, what it is called there; such a group leaves the reference out.
std::string viewerGroup(std::string_view kind, std::string_view head, std::string_view panes,
                        std::string_view step = {});

/// crops: parts of the pictures that get buttons of their own; all must lie in the pictures. exposure: stops that the
/// pictures are brighter than their floats; the slider adds to them.
std::string viewer(std::string_view groups, std::span<const PictureCrop> crops = {}, double exposure = 0);

/// The colours of maps (metrics/false_colour.h) with their values.
std::string colourBar(double range);

}  // namespace wavecrest

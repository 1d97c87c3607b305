// Parts of messages: the known word that is closest to one that is not known, and lists of alternatives.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wavecrest {

// The closest by edits (insert, delete, replace, swap neighbours), if at most a third of the letters differ; or the
// only one that begins with the word. Else empty.
std::string closestWord(std::string_view word, std::span<const std::string> known);

// "; did you mean 'X'?", or nothing: for the end of a message.
std::string didYouMean(std::string_view word, std::span<const std::string> known);

// "ppm, bpm or vcm".
std::string alternatives(std::span<const std::string_view> words);

}  // namespace wavecrest

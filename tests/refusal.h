// What a call says when it is refused.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace wavecrest {

// The text of the Failure that function throws.
template <class Failure, class Function>
std::string refusalOf(Function&& function) {
  try {
    function();
  } catch (const Failure& failure) {
    return failure.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

}  // namespace wavecrest

// A results file that cannot be used. The text is complete: "FILE: what is wrong; what was expected".
#pragma once

#include <stdexcept>

namespace wavecrest {

struct ResultsFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace wavecrest

// What went wrong, as one line and the exit code of its kind.
#pragma once

#include <exception>
#include <string>

namespace wavecrest {

struct Failure {
  int exitCode = 0;  // 0: nothing went wrong
  std::string line;  // without `wavecrest: `
};

Failure failureOf(const std::exception_ptr& thrown);

// A failure that all processes of a render know of, and that the first of them has said.
struct SharedFailure {
  int exitCode = 0;
};

}  // namespace wavecrest

// A function for each alternative of a variant, for std::visit.
#pragma once

namespace wavecrest {

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;  // which clang 14, that lints, does not find by itself

}  // namespace wavecrest

#include "bench/score/build_name.h"

#include <fmt/format.h>

#include "engine/version.h"
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace wavecrest {

std::string compilerName() {
#ifdef __clang__
  return fmt::format("Clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return fmt::format("GCC {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
}

std::string buildName() { return fmt::format("{}, {}, Embree {}", kVersion, compilerName(), RTC_VERSION_STRING); }

}  // namespace wavecrest

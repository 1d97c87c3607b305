#include "cli/failure.h"

#include <cerrno>
#include <cstring>
#include <new>

#include "bench/against/child_render.h"
#include "bench/against/stop_signals.h"
#include "bench/ranks/mpi_library.h"
#include "library/errors.h"
#include "library/translate.h"

namespace wavecrest {

// Which exception is whose fault is written in library/error.cpp. Here stand only those of processes, which the library
// neither starts nor is one of, and what the command line can advise beyond it.
Failure failureOf(const std::exception_ptr& thrown) {
  const auto error = [](int exitCode, const std::string& text) { return Failure{exitCode, "error: " + text}; };
  try {
    std::rethrow_exception(thrown);
  } catch (const ChildStopped& child) {
    return error(kExitInterrupted, child.what());
  } catch (const ChildError& child) {
    return error(kExitFailure, child.what());
  } catch (const RanksError& ranks) {
    return error(kExitFailure, ranks.what());
  } catch (const std::bad_alloc&) {
    return error(kExitFailure,
                 "out of memory; expected a smaller film or scene, fewer --threads, or a budget by --memory");
  } catch (...) {
    const api::Error known = currentError();
    const std::string text = known.what();
    if (known.kind() == api::ErrorKind::usage) return error(kExitUsage, text);
    if (known.kind() == api::ErrorKind::input) return error(kExitInput, text);
    // The standard library's threads and TBB's fail with texts of their own, which end alike.
    if (!text.ends_with(std::strerror(EAGAIN))) return {kExitFailure, "internal error: " + text};
    return error(kExitFailure, text + "; expected enough memory and processes for all threads, or fewer --threads");
  }
}

}  // namespace wavecrest

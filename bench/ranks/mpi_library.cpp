#include "bench/ranks/mpi_library.h"

#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace wavecrest {

const MpiFunctions& loadMpi() {
  constexpr const char* kFile = "libwavecrest_mpi.so";
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  std::string wrong = "there is no " + std::string(kFile);
  for (const std::filesystem::path& place : {folder / kFile, folder / WAVECREST_PLUGIN_FOLDER / kFile}) {
    if (!std::filesystem::exists(place, ignored)) continue;
    // MPI loads parts of itself in turn, which look for its symbols among those of the whole program.
    void* const library = dlopen(place.c_str(), RTLD_NOW | RTLD_GLOBAL);
    using Functions = const MpiFunctions* (*)();
    const auto functions = library == nullptr ? nullptr : reinterpret_cast<Functions>(dlsym(library, kMpiPluginSymbol));
    if (functions == nullptr) {
      const char* const reason = dlerror();
      wrong = reason == nullptr ? place.string() : reason;
    } else if (functions()->version != kMpiPluginVersion) {
      wrong = place.string() + " is of another version";
    } else {
      return *functions();
    }
  }
  throw RanksError(wrong);
}

}  // namespace wavecrest

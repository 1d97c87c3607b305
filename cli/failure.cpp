#include "cli/failure.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>

#include "bench/against/child_render.h"
#include "bench/checkpoint/checkpoint.h"
#include "bench/ranks/mpi_library.h"
#include "engine/load/load.h"
#include "engine/scene/scene_error.h"
#include "library/errors.h"
#include "library/translate.h"
#include "metrics/image/image.h"
#include "scenes/scene_list.h"

namespace wavecrest {

Failure failureOf(const std::exception_ptr& thrown) {
  const auto error = [](int exitCode, const std::string& text) { return Failure{exitCode, "error: " + text}; };
  try {
    std::rethrow_exception(thrown);
  } catch (const UsageError& usage) {
    return error(kExitUsage, usage.what());
  } catch (const MissingFileError& missing) {
    return error(kExitInput, textOf(missing));
  } catch (const LoadError& load) {
    return error(kExitInput, load.what());
  } catch (const SceneError& scene) {
    return error(kExitInput, scene.what());
  } catch (const SceneFolderError& folder) {
    return error(kExitInput, folder.what());
  } catch (const ImageError& image) {
    return error(kExitInput, image.what());
  } catch (const CheckpointError& checkpoint) {
    return error(kExitInput, checkpoint.what());
  } catch (const InputError& input) {
    return error(kExitInput, input.what());
  } catch (const std::filesystem::filesystem_error& file) {
    return error(kExitInput, textOf(file));
  } catch (const nlohmann::json::exception&) {
    return error(kExitInput, kForeignJson);
  } catch (const ChildStopped& child) {
    return error(kExitInterrupted, child.what());
  } catch (const ChildError& child) {
    return error(kExitFailure, child.what());
  } catch (const RanksError& ranks) {
    return error(kExitFailure, ranks.what());
  } catch (const std::bad_alloc&) {
    return error(kExitFailure,
                 "out of memory; expected a smaller film or scene, fewer --threads, or a budget by --memory");
  } catch (const std::exception& other) {
    // The standard library's threads and TBB's fail with texts of their own, which end alike.
    const std::string text = other.what();
    if (!text.ends_with(std::strerror(EAGAIN))) return {kExitFailure, "internal error: " + text};
    return error(kExitFailure, text + "; expected enough memory and processes for all threads, or fewer --threads");
  } catch (...) {
    return {kExitFailure, "internal error"};
  }
}

}  // namespace wavecrest

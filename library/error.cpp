#include "wavecrest/error.h"

#include <fmt/format.h>

#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>

#include "bench/campaign/file_lock.h"
#include "bench/campaign/reference_agreement.h"
#include "bench/campaign/render_reference.h"
#include "bench/campaign/scene_reference.h"
#include "bench/checkpoint/checkpoint.h"
#include "bench/report/results_folder.h"
#include "bench/results/results_error.h"
#include "engine/load/load.h"
#include "engine/plan/memory_use.h"
#include "engine/scene/scene_error.h"
#include "library/errors.h"
#include "library/suggestion.h"
#include "library/translate.h"
#include "metrics/image/image.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace api {

Error::Error(ErrorKind kind, const std::string& text, const std::string& file, int line)
    : std::runtime_error(text), kind_(kind), file_(file), line_(line) {}
Error::~Error() = default;

}  // namespace api

namespace {

// An input error whose text alone names the file.
api::Error inputError(const std::exception& error) { return {api::ErrorKind::input, error.what()}; }

// An input error with file and line.
api::Error loadError(const LoadError& error, const std::string& text) {
  return {api::ErrorKind::input, text, error.location.file, static_cast<int>(error.location.line)};
}

}  // namespace

std::string textOf(const MissingFileError& error) {
  // A known asset that has not been fetched or generated.
  const std::string hint = missingAssetHint(error.file);
  if (!hint.empty()) return std::string(error.what()) + ": " + hint;
  // A scene file (line 0) that looks like a name may be a built-in scene misspelt.
  const bool maybeName = error.location.line == 0 && !error.file.has_parent_path() && !error.file.has_extension();
  if (!maybeName) return error.what();
  // The message suggests the closest name.
  std::vector<std::string> known;
  for (const SceneEntry& scene : builtInScenes()) known.emplace_back(scene.name);
  return std::string(error.what()) + ", or a name that `wavecrest scenes` lists" +
         didYouMean(error.file.string(), known);
}

std::string textOf(const std::filesystem::filesystem_error& error) {
  return fmt::format("{}: {}; expected a file or folder that can be reached", error.path1().string(),
                     error.code().message());
}

api::Error currentError() {
  // Rethrows the exception being handled, to tell its type. Derived types stand before their bases: MissingFileError
  // before LoadError.
  try {
    throw;
  } catch (const api::Error& error) {
    return error;
  } catch (const UsageError& error) {
    return {api::ErrorKind::usage, error.what()};
  } catch (const InputError& error) {
    return inputError(error);
  } catch (const MemoryBudgetError& error) {
    return {api::ErrorKind::usage, std::string("--memory: ") + error.what()};
  } catch (const MissingFileError& error) {
    return loadError(error, textOf(error));
  } catch (const LoadError& error) {
    return loadError(error, error.what());
  } catch (const SceneError& error) {
    return {api::ErrorKind::input, error.what(), error.location.file, static_cast<int>(error.location.line)};
  } catch (const SceneFolderError& error) {
    return inputError(error);
  } catch (const ImageError& error) {
    return inputError(error);
  } catch (const CheckpointError& error) {
    return inputError(error);
  } catch (const ReferenceError& error) {
    return inputError(error);
  } catch (const FileLockError& error) {
    return inputError(error);
  } catch (const ReferenceMismatch& error) {
    return inputError(error);
  } catch (const ReferenceComparisonError& error) {
    return inputError(error);
  } catch (const ResultsError& error) {
    return inputError(error);
  } catch (const ResultsFileError& error) {
    return inputError(error);
  } catch (const std::filesystem::filesystem_error& error) {
    return {api::ErrorKind::input, textOf(error), error.path1().string()};
  } catch (const nlohmann::json::exception&) {
    return {api::ErrorKind::input, kForeignJson};
  } catch (const std::bad_alloc&) {
    // What is left are faults of the library or the machine.
    return {api::ErrorKind::fault, "out of memory"};
  } catch (const std::exception& error) {
    return {api::ErrorKind::fault, error.what()};
  } catch (...) {
    return {api::ErrorKind::fault, "unknown error"};
  }
}

}  // namespace wavecrest

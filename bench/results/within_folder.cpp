#include "bench/results/within_folder.h"

#include <algorithm>
#include <system_error>

#include "bench/results/results_error.h"
#include "metrics/image/real_name.h"

namespace wavecrest {

namespace fs = std::filesystem;

bool isWithinFolder(const fs::path& folder, const fs::path& file) {
  if (file.is_absolute() || std::find(file.begin(), file.end(), "..") != file.end()) return false;
  // Both as they are after all symbolic links. A loop of links is an error.
  std::error_code ofRoot, ofFile;
  const fs::path root = realName(folder.empty() ? fs::path(".") : folder, ofRoot);
  const fs::path real = realName((folder.empty() ? fs::path(".") : folder) / file, ofFile);
  if (ofRoot || ofFile) return false;
  return std::mismatch(root.begin(), root.end(), real.begin(), real.end()).first == root.end();
}

fs::path withinFolder(const fs::path& folder, const fs::path& file) {
  if (isWithinFolder(folder, file)) return folder / file;
  throw ResultsFileError((folder.empty() ? "the current folder" : folder.string()) + ": '" + file.string() +
                         "' leads out of it; expected names and links that stay within the folder");
}

}  // namespace wavecrest

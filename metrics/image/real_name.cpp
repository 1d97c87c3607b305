#include "metrics/image/real_name.h"

namespace wavecrest {

namespace fs = std::filesystem;

fs::path realName(const fs::path& name, std::error_code& error) {
  fs::path file = fs::absolute(name, error);
  if (error) return {};
  // weakly_canonical() does not follow a link whose target is missing. Linux follows at most 40 links, too.
  constexpr int kMostLinks = 40;
  std::error_code ignored;
  for (int links = 0; links < kMostLinks && fs::is_symlink(file, ignored) && !fs::exists(file, ignored); ++links) {
    file = file.parent_path() / fs::read_symlink(file, ignored);
  }
  return fs::weakly_canonical(file, error);
}

fs::path realName(const fs::path& name) {
  std::error_code error;
  fs::path real = realName(name, error);
  if (!error) return real;
  std::error_code ignored;
  const fs::path file = fs::absolute(name, ignored);
  return ignored ? name : file.lexically_normal();
}

}  // namespace wavecrest

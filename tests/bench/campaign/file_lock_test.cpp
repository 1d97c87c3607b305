// Whoever works on a file keeps others from it, by whatever name they know it.
#include "bench/campaign/file_lock.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/metrics/temporary_folder.h"

namespace wavecrest {
namespace {

TEST(FileLock, isOfTheFileBehindALinkAlsoBeforeThatIsThere) {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("file", folder.path("link"));
  {
    const FileLock lock(folder.path("link"));
    EXPECT_THROW(FileLock(folder.path("file")), FileIsLocked);
    EXPECT_THROW(FileLock(folder.path("link")), FileIsLocked);
  }
  EXPECT_NO_THROW(FileLock(folder.path("file")));
}

}  // namespace
}  // namespace wavecrest

// Whole files in and out, in places that are not as clean as usual.
#include "metrics/image/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "metrics/image/image.h"
#include "metrics/image/real_name.h"
#include "tests/metrics/temporary_folder.h"
#include "tests/refusal.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

struct AtomicFiles : testing::Test, test::TemporaryFolder {
  std::string content(const std::string& name) const {
    const std::vector<unsigned char> bytes = readFileBytes(path(name));
    return {bytes.begin(), bytes.end()};
  }
  // What a writer with the number of this process has left behind when it was killed.
  void leaveTemporaries(const std::string& name, unsigned count) const {
    for (unsigned i = 0; i < count; ++i) {
      write(name + ".tmp." + std::to_string(::getpid()) + "." + std::to_string(i), "left");
    }
  }
};

TEST_F(AtomicFiles, leftoversOfAKilledProcessOfTheSameNumberAreNoObstacle) {
  constexpr unsigned kLeftovers = 500;
  leaveTemporaries("a", kLeftovers);
  EXPECT_NO_THROW(checkWritable(path("a")));
  leaveTemporaries("b", kLeftovers);
  writeFileAtomically(path("b"), "new");
  EXPECT_EQ(content("b"), "new");
  // They are left as they are, and removed by those who know that nobody writes.
  EXPECT_EQ(content("b.tmp." + std::to_string(::getpid()) + ".0"), "left");
  removeTemporaries(path("b"));
  EXPECT_FALSE(fs::exists(path("b.tmp." + std::to_string(::getpid()) + ".0")));
}

TEST_F(AtomicFiles, theFileBehindALinkIsReplacedOrMade) {
  fs::create_directory(path("sub"));
  fs::create_symlink("there", path("link"));
  fs::create_symlink("../absent", path("sub/far"));
  fs::create_symlink("sub/far", path("chain"));
  write("there", "old");
  for (const char* name : {"link", "chain"}) {
    checkWritable(path(name));
    writeFileAtomically(path(name), "new");
    EXPECT_TRUE(fs::is_symlink(path(name))) << name;
  }
  EXPECT_TRUE(fs::is_symlink(path("sub/far")));
  EXPECT_EQ(content("there"), "new");
  EXPECT_EQ(content("absent"), "new");
}

TEST_F(AtomicFiles, aLinkThatLeadsToNoFileIsRefusedAndStays) {
  fs::create_symlink("loop", path("loop"));
  fs::create_symlink("no/folder", path("lost"));
  const std::string loop = path("loop");
  const std::string refusal =
      loop + ": is a link that leads to no file: Too many levels of symbolic links; expected one that does";
  EXPECT_EQ(refusalOf<ImageError>([&] { checkWritable(loop); }), refusal);
  EXPECT_EQ(refusalOf<ImageError>([&] { writeFileAtomically(loop, "new"); }), refusal);
  EXPECT_THROW(checkWritable(path("lost")), ImageError);
  EXPECT_THROW(writeFileAtomically(path("lost"), "new"), ImageError);
  EXPECT_TRUE(fs::is_symlink(loop));
  EXPECT_TRUE(fs::is_symlink(path("lost")));
}

TEST_F(AtomicFiles, aPipeIsNoFileToRead) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_EQ(refusalOf<ImageError>([&] { readFileBytes(path("pipe")); }),
            path("pipe") + ": is not a regular file; expected a file");
}

TEST_F(AtomicFiles, aFileIsReadInPiecesUpToItsEnd) {
  FileReader file(write("a", "123456789"));
  EXPECT_EQ(file.size(), 9u);
  EXPECT_EQ(file.read(4), (std::vector<unsigned char>{'1', '2', '3', '4'}));
  EXPECT_EQ(file.read(1).front(), '5');
  EXPECT_EQ(file.read(UINT64_MAX).size(), 4u);
  EXPECT_TRUE(file.read(1).empty());
}

TEST_F(AtomicFiles, aFileHasOneRealNameAlsoBeforeItIsThere) {
  const fs::path root = fs::canonical(folder());
  fs::create_directories(path("sub/inner"));
  fs::create_symlink("sub/inner", path("other"));
  fs::create_symlink("sub/inner/new", path("link"));
  fs::create_symlink("other/../new", path("up"));
  fs::create_symlink("link", path("chain"));
  EXPECT_EQ(realName(path("other/new")), root / "sub/inner/new");
  EXPECT_EQ(realName(path("link")), root / "sub/inner/new");
  EXPECT_EQ(realName(path("chain")), root / "sub/inner/new");
  EXPECT_EQ(realName(path("up")), root / "sub/new");
  EXPECT_EQ(realName("absent"), fs::current_path() / "absent");
}

TEST_F(AtomicFiles, linksInACircleHaveNoRealName) {
  fs::create_symlink("second", path("first"));
  fs::create_symlink("first", path("second"));
  std::error_code error;
  EXPECT_EQ(realName(path("first"), error), fs::path());
  EXPECT_EQ(error, std::errc::too_many_symbolic_link_levels);
  EXPECT_EQ(realName(path("first")), path("first"));
}

}  // namespace
}  // namespace wavecrest

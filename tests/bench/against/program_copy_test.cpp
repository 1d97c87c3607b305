#include "bench/against/program_copy.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "bench/against/child_render.h"

namespace wavecrest {
namespace {

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

ino_t fileOf(const std::filesystem::path& path) {
  struct stat about {};
  return stat(path.c_str(), &about) == 0 ? about.st_ino : 0;
}

int run(const std::filesystem::path& program) { return std::system(program.c_str()); }

TEST(ProgramCopyTest, EachCopyIsAFileOfItsOwnThatRuns) {
  ProgramCopy program("/bin/true");
  EXPECT_EQ(program.path(), "/bin/true");
  program.renew();
  const ino_t first = fileOf(program.path());
  EXPECT_EQ(contentOf(program.path()), contentOf("/bin/true"));
  EXPECT_EQ(run(program.path()), 0);
  program.renew();
  EXPECT_NE(fileOf(program.path()), first);
  EXPECT_EQ(run(program.path()), 0);
}

TEST(ProgramCopyTest, StaysWhereItIsIfToldSo) {
  ProgramCopy program("/bin/true");
  program.renew();
  program.stayInPlace();
  program.renew();
  EXPECT_TRUE(program.inPlace());
  EXPECT_EQ(program.path(), "/bin/true");
}

TEST(ProgramCopyTest, RefusesWhatIsNotThere) {
  ProgramCopy program("/bin/there-is-no-such-program");
  EXPECT_THROW(program.renew(), ChildError);
}

}  // namespace
}  // namespace wavecrest

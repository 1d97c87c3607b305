// Texts of Linux's files, as machines have them.
#include "bench/machine/system_files.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <string>

namespace wavecrest {
namespace {

TEST(ProcStat, busyTimeLeavesOutIdlingAndStealIsApart) {
  const auto times = parseProcStat("cpu  100 20 30 5000 400 7 3 50 0 0\ncpu0 1 2 3 4 5 6 7 8 9 10\n", 100);
  ASSERT_TRUE(times);
  EXPECT_DOUBLE_EQ(times->busy, 1.6);
  EXPECT_DOUBLE_EQ(times->steal, 0.5);
}

TEST(ProcStat, aShortOrMissingLineIsNone) {
  EXPECT_FALSE(parseProcStat("", 100));
  EXPECT_FALSE(parseProcStat("cpu 1 2 3 4\n", 100));
  EXPECT_FALSE(parseProcStat("intr 1 2 3 4 5 6 7 8 9\n", 100));
}

TEST(CpuMax, isAQuotaOverItsPeriodOrNone) {
  EXPECT_DOUBLE_EQ(parseCpuMax("150000 100000\n").value(), 1.5);
  EXPECT_FALSE(parseCpuMax("max 100000\n"));
  EXPECT_FALSE(parseCpuMax(""));
}

TEST(CpuMax, isTheLeastOfAGroupAndItsParents) {
  std::map<std::string, std::string> files = {{"/sys/fs/cgroup/user.slice/job.scope/cpu.max", "400000 100000\n"},
                                              {"/sys/fs/cgroup/user.slice/cpu.max", "150000 100000\n"},
                                              {"/sys/fs/cgroup/cpu.max", "max 100000\n"}};
  const auto limitOf = [&](const char* groups) {
    return leastCpuMax(groups, [&](const std::string& path) { return files[path]; });
  };
  EXPECT_EQ(limitOf("12:cpu:/old\n0::/user.slice/job.scope\n"), 1.5);
  files["/sys/fs/cgroup/user.slice/job.scope/cpu.max"] = "50000 100000\n";
  EXPECT_EQ(limitOf("0::/user.slice/job.scope\n"), 0.5);
  for (const char* groups : {"", "0::/\n", "12:cpu:/user.slice\n"}) EXPECT_EQ(limitOf(groups), std::nullopt) << groups;
  files["/sys/fs/cgroup/cpu.max"] = "200000 100000\n";
  EXPECT_EQ(limitOf("0::/\n"), 2.0) << "a container's own group";
}

TEST(ChosenWord, isTheOneInBrackets) {
  EXPECT_EQ(chosenWord("always [madvise] never\n"), "madvise");
  EXPECT_EQ(chosenWord("always madvise"), "");
}

TEST(CpuInfo, keysAreWhole) {
  constexpr auto kInfo =
      "processor\t: 0\nmodel\t\t: 143\nmodel name\t: A CPU @ 2 GHz\nflags\t\t: fpu avx2 hypervisor\n";
  EXPECT_EQ(cpuInfoValue(kInfo, "model name"), "A CPU @ 2 GHz");
  EXPECT_EQ(cpuInfoValue(kInfo, "model"), "143");
  EXPECT_EQ(cpuInfoValue(kInfo, "mod"), "");
}

TEST(CpuName, hasFamilyAndModelWhereItTellsNoProcessor) {
  const std::string rest = "\ncpu family\t: 25\nmodel\t\t: 17\n";
  EXPECT_EQ(cpuName("model name\t: AMD EPYC" + rest), "AMD EPYC (family 25, model 17)");
  EXPECT_EQ(cpuName("model name\t: AMD EPYC 9654 96-Core Processor" + rest), "AMD EPYC 9654 96-Core Processor");
  EXPECT_EQ(cpuName("model name\t: a CPU\n"), "a CPU");
  EXPECT_EQ(cpuName(""), "unknown");
}

TEST(Flags, areThoseThatKernelsUse) {
  EXPECT_EQ(relevantFlags("fpu hypervisor avx2 avx512f_x"), (std::vector<std::string>{"avx2", "hypervisor"}));
}

}  // namespace
}  // namespace wavecrest

// Topologies that hwloc makes up are described as they were asked for.
#include "bench/machine/topology.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "bench/machine/machine_record.h"

namespace wavecrest {
namespace {

TEST(Topology, twoSocketsOf56CoresWithTwoThreadsEach) {
  const Topology t = syntheticTopology("package:2 numa:1 l3:1(size=110100480) l2:56(size=2097152) core:1 pu:2");
  EXPECT_EQ(t.sockets, 2u);
  EXPECT_EQ(t.numaNodes, 2u);
  EXPECT_EQ(t.cores, 112u);
  EXPECT_EQ(t.hardwareThreads, 224u);
  EXPECT_EQ(t.smt, 2u);
  EXPECT_EQ(t.usableCores, 112u);
  EXPECT_EQ(t.usableThreads, 224u);
  EXPECT_EQ(t.l3Bytes, 110100480u);
  EXPECT_EQ(t.l3Caches, 2u);
  EXPECT_EQ(t.l2Bytes, 2097152u);
}

TEST(Topology, fourNodesInASocket) {
  const Topology t = syntheticTopology("package:1 numa:4 core:16 pu:1");
  EXPECT_EQ(t.sockets, 1u);
  EXPECT_EQ(t.numaNodes, 4u);
  EXPECT_EQ(t.cores, 64u);
  EXPECT_EQ(t.smt, 1u);
  EXPECT_EQ(t.l3Caches, 0u);
  EXPECT_EQ(t.l3Bytes, 0u);
}

TEST(Topology, anOddMaskCountsCoresThatItTouches) {
  // Hardware threads 0 and 1 are the first core's.
  const Topology t = syntheticTopology("package:1 numa:1 core:4 pu:2", "1,4-5");
  EXPECT_EQ(t.usableThreads, 3u);
  EXPECT_EQ(t.usableCores, 2u);
  EXPECT_EQ(t.affinity, "1,4-5");
  EXPECT_EQ(t.hardwareThreads, 8u);
}

TEST(Topology, whatHwlocCannotReadIsRefused) {
  EXPECT_THROW(syntheticTopology("package:x"), std::invalid_argument);
  EXPECT_THROW(syntheticTopology("package:1 core:2 pu:1", "a"), std::invalid_argument);
}

TEST(MachineRecord, ofThisMachineIsWhole) {
  const MachineRecord& machine = machineRecord();
  EXPECT_GE(machine.topology.usableThreads, 1u);
  EXPECT_LE(machine.topology.usableThreads, machine.topology.hardwareThreads);
  EXPECT_GT(machine.mhz, 300);
  EXPECT_LT(machine.mhz, 10000);
  const nlohmann::ordered_json json = toJson(machine);
  for (const char* key : {"sockets", "cores", "smt", "affinity", "governor", "mhz", "huge_pages", "flags", "load"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
}

}  // namespace
}  // namespace wavecrest

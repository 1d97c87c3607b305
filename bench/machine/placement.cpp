#include "bench/machine/placement.h"

#include <algorithm>
#include <future>
#include <map>

#include "engine/tasks/thread_pins.h"

namespace wavecrest {
namespace {

// A node's hardware threads in the order in which they are taken: the first of every core, then the second, and so on.
struct Node {
  uint32_t number = 0;
  size_t cores = 0;
  std::vector<uint32_t> cpus;
};

// The nodes of these hardware threads, by ascending number.
std::vector<Node> nodesOf(std::vector<HardwareThread> usable) {
  // Sorting makes the hardware threads of a core neighbours. A rank is the place of a hardware thread within a core.
  std::sort(usable.begin(), usable.end(), [](const HardwareThread& a, const HardwareThread& b) {
    return std::pair(a.core, a.cpu) < std::pair(b.core, b.cpu);
  });
  struct Ranked {
    size_t rank;  // in its core
    uint32_t core, cpu;
  };
  std::map<uint32_t, std::vector<Ranked>> byNode;
  for (size_t i = 0, rank = 0; i < usable.size(); ++i) {
    rank = i > 0 && usable[i].core == usable[i - 1].core ? rank + 1 : 0;
    byNode[usable[i].node].push_back({rank, usable[i].core, usable[i].cpu});
  }
  // The hardware threads of a node are sorted by rank, and by core within a rank.
  std::vector<Node> nodes;
  for (auto& [number, ranked] : byNode) {
    std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) { return a.rank < b.rank; });
    Node& node = nodes.emplace_back(Node{.number = number, .cores = 0, .cpus = {}});
    for (const Ranked& each : ranked) {
      node.cpus.push_back(each.cpu);
      if (each.rank == 0) ++node.cores;
    }
  }
  return nodes;
}

}  // namespace

PlacementPlan placeThreads(std::vector<HardwareThread> usable, uint32_t threads) {
  const size_t count = usable.size();
  if (count < threads) {
    return {{}, std::to_string(threads) + " threads for " + std::to_string(count) + " hardware threads"};
  }
  // As few nodes as have cores enough, the largest first; else all.
  std::vector<Node> nodes = nodesOf(std::move(usable));
  std::stable_sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.cores > b.cores; });
  size_t cores = 0, used = 0;
  while (used < nodes.size() && cores < threads) cores += nodes[used++].cores;
  nodes.resize(used);
  std::sort(nodes.begin(), nodes.end(), [](const Node& a, const Node& b) { return a.number < b.number; });

  // One to each node in turn. A node whose cores all have a thread waits until those of all nodes have.
  Placement placement;
  for (const Node& node : nodes) placement.nodes.push_back(node.number);
  std::vector<size_t> taken(nodes.size(), 0);
  // room(node): how many hardware threads of a node may be taken.
  const auto deal = [&](const auto& room) {
    for (bool any = true; any && placement.cpus.size() < threads;) {
      any = false;
      for (size_t i = 0; i < nodes.size() && placement.cpus.size() < threads; ++i) {
        if (taken[i] == room(nodes[i])) continue;
        placement.cpus.push_back(nodes[i].cpus[taken[i]++]);
        any = true;
      }
    }
  };
  // First a hardware thread of each core, then the rest.
  deal([](const Node& node) { return node.cores; });
  deal([](const Node& node) { return node.cpus.size(); });
  return {std::move(placement), {}};
}

Placement partOf(const Placement& whole, const std::vector<HardwareThread>& usable, size_t first, size_t count) {
  Placement part;
  for (size_t i = first; i < first + count; ++i) {
    part.cpus.push_back(whole.cpus.at(i));
    const auto found = std::find_if(usable.begin(), usable.end(),
                                    [&](const HardwareThread& each) { return each.cpu == part.cpus.back(); });
    if (found != usable.end()) part.nodes.push_back(found->node);
  }
  std::sort(part.nodes.begin(), part.nodes.end());
  part.nodes.erase(std::unique(part.nodes.begin(), part.nodes.end()), part.nodes.end());
  return part;
}

PlacementPlan placeOnThisMachine(uint32_t threads) {
  PlacementPlan plan = placeThreads(usableHardwareThreads(), threads);
  if (plan.placement.cpus.empty()) return plan;
  // In a thread of its own, which takes the binding with it.
  const auto binds = [&] { return std::all_of(plan.placement.cpus.begin(), plan.placement.cpus.end(), bindThread); };
  if (!std::async(std::launch::async, binds).get()) return {{}, "the system does not let threads be bound"};
  return plan;
}

}  // namespace wavecrest

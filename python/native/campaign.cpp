// Campaigns and their results.
#include <nanobind/stl/function.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <exception>

#include "interrupt.h"
#include "native.h"

namespace wavecrest::python {
namespace {

using Words = std::map<std::string, std::vector<std::string>>;

// say: called with a line now and then, from this thread; an exception of it ends the campaign after the run under way
// and is thrown then. False: Ctrl-C ended it.
bool converge(const Words& defining, const std::string& out, const std::string& reference, const std::string& shard,
              const std::string& isa, uint32_t threads, bool checkpoints, bool resume, bool check,
              const std::function<void(const std::string&)>& say) {
  const api::CampaignOptions options{.defining = defining,
                                     .out = out,
                                     .reference = reference,
                                     .shard = shard,
                                     .isa = isa,
                                     .threads = threads,
                                     .checkpoints = checkpoints,
                                     .resume = resume,
                                     .check = check};
  api::StopRequest stop;
  std::exception_ptr thrown;  // by say
  const auto tell = [&](const std::string& line) {
    if (thrown) return;
    const nb::gil_scoped_acquire acquire;
    try {
      say(line);
    } catch (const nb::python_error&) {
      thrown = std::current_exception();
      stop.request();
    }
  };
  const api::CampaignCallbacks callbacks{
      .finished =
          [&](const api::RunRecord& run, const api::CampaignProgress& progress) {
            tell("[" + std::to_string(progress.done) + "/" + std::to_string(progress.total) + "] " + run.scene + " " +
                 run.method + " seed " + std::to_string(run.seed) + (run.reason.empty() ? "" : ": " + run.reason));
          },
      .say = tell};
  InterruptScope interrupt([](void* what) { static_cast<api::StopRequest*>(what)->request(); }, &stop);
  bool done = false;
  {
    const nb::gil_scoped_release release;
    done = api::converge(options, callbacks, &stop);
  }
  const bool interrupted = interrupt.interrupted();
  if (!thrown) return done && !interrupted;
  try {
    std::rethrow_exception(thrown);
  } catch (const nb::python_error& error) {
    if (!error.matches(PyExc_KeyboardInterrupt)) throw;
  }
  return false;
}

template <class Map>
nb::dict toDict(const Map& map) {
  nb::dict dict;
  for (const auto& [key, value] : map) dict[key.c_str()] = value;
  return dict;
}

nb::dict toDict(const api::RunRecord& run) {
  nb::list snapshots;
  for (const api::SnapshotRecord& snapshot : run.snapshots) {
    nb::dict row;
    row["number"] = snapshot.number;
    row["seconds"] = snapshot.renderSeconds;
    row["iterations"] = snapshot.iterations;
    row["file"] = snapshot.file;
    row["scores"] = toDict(snapshot.values);
    snapshots.append(row);
  }
  nb::dict dict;
  dict["scene"] = run.scene;
  dict["method"] = run.method;
  dict["seed"] = run.seed;
  dict["refused"] = run.state == api::RunState::refused;
  dict["reason"] = run.reason;
  dict["stats"] = run.stats;
  dict["snapshots"] = snapshots;
  return dict;
}

nb::dict toDict(const api::SceneRecord& scene) {
  nb::dict dict;
  dict["name"] = scene.name;
  dict["hash"] = scene.hash;
  dict["reference"] = scene.referenceFile;
  dict["width"] = scene.width;
  dict["height"] = scene.height;
  dict["noise_floors"] = toDict(scene.noiseFloors);
  return dict;
}

nb::dict toDict(const api::ClaimRecord& claim) {
  nb::dict dict;
  dict["id"] = claim.id;
  dict["scene"] = claim.scene;
  dict["statement"] = claim.statement;
  dict["verdict"] = claim.verdict;
  dict["figure"] = claim.figure;
  dict["evidence"] = claim.evidence;
  return dict;
}

template <class Record>
nb::list toList(const std::vector<Record>& records) {
  nb::list list;
  for (const Record& record : records) list.append(toDict(record));
  return list;
}

nb::dict readResults(const std::string& path) {
  const api::CampaignResults results = api::readResults(path);
  nb::dict dict;
  dict["campaign"] = toDict(results.campaign);
  dict["scenes"] = toList(results.scenes);
  dict["runs"] = toList(results.runs);
  dict["claims"] = toList(results.claims);
  return dict;
}

}  // namespace

void addCampaign(nb::module_& module) {
  module.def("converge", &converge, nb::arg("defining"), nb::arg("out"), nb::arg("reference"), nb::arg("shard"),
             nb::arg("isa"), nb::arg("threads"), nb::arg("checkpoints"), nb::arg("resume"), nb::arg("check"),
             nb::arg("say"));
  module.def("read_results", &readResults, nb::arg("path"),
             nb::sig("def read_results(path: str) -> dict[str, typing.Any]"));
}

}  // namespace wavecrest::python

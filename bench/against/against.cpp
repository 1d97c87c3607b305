#include "bench/against/against.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/against/child_render.h"
#include "bench/against/program_copy.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

constexpr double kLongestRun = 0.25;  // CPU seconds: short, so that a pair meets the machine in one state
constexpr double kPatience = 20, kSlowest = 20;

double cpuSecondsOf(const nlohmann::json& stats) { return stats.at("cpu_seconds").get<double>(); }

std::string versionOf(const nlohmann::json& stats) {
  return fmt::format("{} {}", stats.value("version", "?"), stats.value("commit", "?"));
}

// Whether the images have the same bits, and their relative difference. Images of different sizes have a difference of
// 1.
void compareImages(const Image& ours, const Image& other, AgainstRow& row) {
  row.sameImage = ours.width == other.width && ours.height == other.height && ours.pixels == other.pixels;
  if (ours.pixels.size() != other.pixels.size()) {
    row.imageDifference = 1;
    return;
  }
  double square = 0, difference = 0;
  for (size_t i = 0; i < other.pixels.size(); ++i) {
    const double value = other.pixels[i], d = static_cast<double>(ours.pixels[i]) - value;
    square += value * value;
    difference += d * d;
  }
  // The difference is relative to the other's image, or absolute where that image is black.
  row.imageDifference = square > 0 ? std::sqrt(difference / square) : std::sqrt(difference);
}

// All runs of one request: copies the programs, prepares each row, measures in rounds, and judges.
class Runner {
 public:
  explicit Runner(const AgainstRequest& request)
      : request_(request),
        runSeconds_(std::min(kLongestRun, request.seconds / (2.0 * kFewestRounds))),
        ours_(ownBinary()),
        other_(request.other) {
    result_.ours = ownBinary();
    result_.other = request.other;
    result_.threads = request.threads;
    result_.family = request.family;
    for (const fs::path& scene : request.scenes) {
      for (const std::string& method : request.methods) {
        children_.push_back({.scene = scene,
                             .method = method,
                             .size = request.size,
                             .threads = request.threads,
                             .more = request.more,
                             .imageFile = {}});
        AgainstRow& row = result_.rows.emplace_back();
        row.scene = scene.stem().string();
        row.method = method;
      }
    }
  }

  AgainstResult run(const std::function<void(size_t, size_t)>& progress) {
    // Programs that can be copied, and the iterations of each row.
    for (ProgramCopy* program : {&ours_, &other_}) tryCopy(*program);
    for (size_t i = 0; i < children_.size(); ++i) prepare(i);
    // Each round has one pair of runs for each row.
    const size_t rounds = roundsOf(request_.seconds, longestRun_);
    for (size_t round = 0; round < rounds; ++round) {
      for (size_t i = 0; i < children_.size(); ++i) measurePair(i, round);
      progress(round + 1, rounds);
    }
    // Verdicts, corrected for all rows together.
    std::vector<Comparison*> comparisons;
    for (AgainstRow& row : result_.rows) {
      row.comparison = comparePaired(row.ourSeconds, row.otherSeconds, request_.family);
      comparisons.push_back(&row.comparison);
    }
    judge(comparisons, request_.family);
    return std::move(result_);
  }

 private:
  // The other program may be any. It has kPatience, and kSlowest times what this one took at most.
  nlohmann::json render(const ProgramCopy& program, const ChildRequest& child) {
    if (&program == &other_) return renderInChild(program.path(), child, folder_, kPatience + kSlowest * ownSeconds_);
    const auto begin = std::chrono::steady_clock::now();
    nlohmann::json stats = renderInChild(program.path(), child, folder_);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    ownSeconds_ = std::max(ownSeconds_, took.count());
    return stats;
  }

  // Not all programs run from anywhere.
  // A program stays in place if its copy fails or names another version.
  void tryCopy(ProgramCopy& program) {
    if (children_.empty()) return;
    const nlohmann::json original = render(program, children_.front());
    try {
      program.renew();
      if (versionOf(render(program, children_.front())) == versionOf(original)) return;
    } catch (const ChildError&) {
    }
    program.stayInPlace();
    result_.inPlace.push_back(&program == &ours_ ? result_.ours : result_.other);
  }

  // Compares one iteration's images, and finds how many iterations fill a run.
  void prepare(size_t i) {
    ChildRequest& child = children_[i];
    const std::string file = (folder_.path() / "image.pfm").string();
    child.imageFile = file;
    // Ours first: the other build's patience follows from how long it took.
    const nlohmann::json ours = render(ours_, child);
    const Image ourImage = readImage(file).image;
    const nlohmann::json other = render(other_, child);
    compareImages(ourImage, readImage(file).image, result_.rows[i]);
    child.imageFile.reset();
    result_.ourVersion = versionOf(ours);
    result_.otherVersion = versionOf(other);
    double seconds = cpuSecondsOf(ours);
    // Iterations so that a run of our build takes runSeconds_.
    // Twice: the first iterations of a render are slower than later ones.
    for (int step = 0; step < 2 && seconds < runSeconds_; ++step) {
      const double factor = runSeconds_ / std::max(seconds, 1e-3);
      child.iterations = static_cast<uint64_t>(std::ceil(static_cast<double>(child.iterations) * factor));
      seconds = cpuSecondsOf(render(ours_, child));
    }
    longestRun_ = std::max({longestRun_, seconds, cpuSecondsOf(other)});
    result_.rows[i].iterations = child.iterations;
  }

  // One run of each build with the same seed, ours first in even rounds.
  void measurePair(size_t i, size_t round) {
    ChildRequest& child = children_[i];
    child.seed = round;
    AgainstRow& row = result_.rows[i];
    for (const size_t turn : {round % 2, 1 - round % 2}) {
      ProgramCopy& program = turn == 0 ? ours_ : other_;
      program.renew();
      (turn == 0 ? row.ourSeconds : row.otherSeconds).push_back(cpuSecondsOf(render(program, child)));
    }
  }

  const AgainstRequest& request_;
  const double runSeconds_;  // CPU time of a run, about
  double longestRun_ = 0;    // CPU time of the longest run, of one iteration where that takes more than runSeconds_
  double ownSeconds_ = 0;    // that a run of this build took at most
  ProgramCopy ours_, other_;
  const ScratchFolder folder_;
  std::vector<ChildRequest> children_;  // one for each row
  AgainstResult result_;
};

}  // namespace

bool AgainstResult::anySlower() const {
  return std::any_of(rows.begin(), rows.end(),
                     [](const AgainstRow& row) { return row.comparison.verdict == SpeedVerdict::slower; });
}

size_t roundsOf(double seconds, double longestRun) {
  const double rounds = std::round(seconds / (2 * std::max(longestRun, kLongestRun)));
  return std::max(kFewestRounds, static_cast<size_t>(rounds));
}

AgainstResult runAgainst(const AgainstRequest& request, const std::function<void(size_t, size_t)>& progress) {
  return Runner(request).run(progress);
}

}  // namespace wavecrest

#include "bench/report/other_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <tuple>

#include "bench/image_attributes.h"
#include "bench/report/run_series.h"
#include "bench/whole_number.h"
#include "metrics/image/image_io.h"

namespace wavecrest {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void failIn(const fs::path& file, size_t line, const std::string& wrong, const std::string& expected) {
  throw ResultsError(fmt::format("{}:{}: {}; expected {}", file.string(), line, wrong, expected));
}

// "4", "0.5", "4s" or "250ms": seconds, finite and not negative.
std::optional<double> secondsOf(std::string_view text) {
  double scale = 1;
  if (text.ends_with("ms")) {
    scale = 1e-3;
    text.remove_suffix(2);
  } else if (text.ends_with('s')) {
    text.remove_suffix(1);
  }
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text.front())) == 0) return std::nullopt;
  const std::optional<double> number = wholeNumber<double>(text);
  if (!number || !std::isfinite(*number)) return std::nullopt;
  return *number * scale;
}

struct TimedName {
  std::string method;
  double seconds = 0;
};

// METHOD.SECONDS: the first dot whose rest is a time, so that "bdpt.0.5" is of half a second.
std::optional<TimedName> timedName(const std::string& stem) {
  for (size_t dot = stem.find('.'); dot != std::string::npos; dot = stem.find('.', dot + 1)) {
    const std::optional<double> seconds = secondsOf(std::string_view(stem).substr(dot + 1));
    if (seconds && dot > 0) return TimedName{stem.substr(0, dot), *seconds};
  }
  return std::nullopt;
}

// One image with all that is known of it.
struct OtherImage {
  std::string scene, method, sceneHash;
  uint64_t seed = 0;
  nlohmann::json settings = nlohmann::json::object();  // seriesSettings()
  SnapshotFile snapshot;
};

// Whether an image is of the render that a run is.
bool isOfRun(const RunFile& run, const OtherImage& image) {
  return run.scene == image.scene && run.sceneHash == image.sceneHash && run.method == image.method &&
         run.seed == image.seed && run.stats == image.settings;
}

// Images of one scene, method, seed and settings are one run, in order of time.
std::vector<RunFile> runsOf(const std::vector<OtherImage>& images) {
  std::vector<RunFile> runs;
  for (const OtherImage& image : images) {
    auto run = std::find_if(runs.begin(), runs.end(), [&](const RunFile& known) { return isOfRun(known, image); });
    if (run == runs.end()) {
      run = runs.insert(runs.end(), RunFile{.path = image.snapshot.image,
                                            .scene = image.scene,
                                            .method = image.method,
                                            .sceneHash = image.sceneHash,
                                            .seed = image.seed,
                                            .stats = image.settings,
                                            .snapshots = {},
                                            .other = true});
    }
    run->snapshots.push_back(image.snapshot);
  }
  for (RunFile& run : runs) {
    std::stable_sort(run.snapshots.begin(), run.snapshots.end(),
                     [](const SnapshotFile& a, const SnapshotFile& b) { return a.seconds < b.seconds; });
  }
  return runs;
}

// ---- lists ----------------------------------------------------------------------------------------------------------

enum class Column { image, seconds, method, seed, iterations, scene };
constexpr std::array<std::string_view, 6> kColumnNames{"image", "seconds", "method", "seed", "iterations", "scene"};

// The fields of a line of CSV: quoted ones may hold commas, and quotes that are doubled.
std::vector<std::string> fieldsOf(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  // Spaces around fields say nothing.
  for (std::string& field : fields) {
    field.erase(0, field.find_first_not_of(" \t\r"));
    field.erase(field.find_last_not_of(" \t\r") + 1);
  }
  return fields;
}

// The columns that a line of names gives; empty if the line is no such line.
std::vector<Column> columnsOf(const fs::path& list, size_t line, const std::vector<std::string>& fields) {
  if (fields.size() == 2 && secondsOf(fields[1])) return {};
  std::vector<Column> columns;
  for (const std::string& field : fields) {
    const auto* const known = std::find(kColumnNames.begin(), kColumnNames.end(), field);
    if (known == kColumnNames.end()) {
      failIn(list, line, fmt::format("unknown column '{}'", field),
             fmt::format("an image and seconds, or names among {}", fmt::join(kColumnNames, ", ")));
    }
    columns.push_back(static_cast<Column>(known - kColumnNames.begin()));
  }
  for (const Column needed : {Column::image, Column::seconds}) {
    if (std::count(columns.begin(), columns.end(), needed) == 1) continue;
    failIn(list, line, fmt::format("'{}' is not once among the columns", kColumnNames[static_cast<size_t>(needed)]),
           "an image and its seconds on each line");
  }
  return columns;
}

// The name of an image without its number: "path" of path_0004.exr and of path.4.exr.
std::string methodOfName(const std::string& stem) {
  if (const std::optional<TimedName> name = timedName(stem)) return name->method;
  const size_t end = stem.find_last_not_of("0123456789");
  std::string method = stem.substr(0, end + 1);
  while (!method.empty() && std::string_view("._- ").find(method.back()) != std::string_view::npos) method.pop_back();
  return method.empty() ? stem : method;
}

// One line of a list. Where it does not name the method, that stays empty.
OtherImage readRow(const fs::path& list, size_t line, const std::vector<Column>& columns,
                   const std::vector<std::string>& fields, const std::string& scene) {
  if (fields.size() != columns.size()) {
    failIn(list, line, fmt::format("has {} fields", fields.size()),
           fmt::format("{} as the first line", columns.size()));
  }
  const auto wrong = [&](size_t i, const char* expected) {
    failIn(list, line, fmt::format("{} is '{}'", kColumnNames[static_cast<size_t>(columns[i])], fields[i]), expected);
  };
  OtherImage image{.scene = scene, .method = {}, .sceneHash = {}, .seed = 0, .snapshot = {}};
  for (size_t i = 0; i < columns.size(); ++i) {
    const std::optional<uint64_t> whole = wholeNumber<uint64_t>(fields[i]);
    switch (columns[i]) {
      case Column::image:
        image.snapshot.image = list.parent_path() / fields[i];
        break;
      case Column::seconds:
        if (!secondsOf(fields[i])) wrong(i, "a time in seconds");
        image.snapshot.seconds = *secondsOf(fields[i]);
        break;
      case Column::method:
        image.method = fields[i];
        break;
      case Column::seed:
        if (!whole) wrong(i, "a whole number");
        image.seed = *whole;
        break;
      case Column::iterations:
        if (!whole) wrong(i, "a whole number");
        image.snapshot.iterations = *whole;
        break;
      case Column::scene:
        image.scene = fields[i];
        break;
    }
  }
  return image;
}

// Names the methods of images without one after their files. Images of one name, scene and seed in several folders are
// of several renders: their folders then stand before the name.
void nameMethods(std::vector<OtherImage>& images, const fs::path& folderOfList) {
  struct Named {
    OtherImage* image;
    std::string folder;
  };
  std::map<std::tuple<std::string, std::string, uint64_t>, std::vector<Named>> renders;
  for (OtherImage& image : images) {
    if (!image.method.empty()) continue;
    const fs::path& file = image.snapshot.image;
    image.method = methodOfName(file.stem().string());
    const fs::path relative = file.lexically_relative(folderOfList);  // empty of an absolute name
    const std::string folder = (relative.empty() ? file : relative).parent_path().generic_string();
    renders[{image.scene, image.method, image.seed}].push_back({&image, folder});
  }
  for (const auto& [name, found] : renders) {
    const bool several =
        std::ranges::any_of(found, [&](const Named& one) { return one.folder != found.front().folder; });
    for (const Named& one : found) {
      if (several && !one.folder.empty()) one.image->method = one.folder + "/" + one.image->method;
    }
  }
}

// Adds what images that wavecrest rendered say of their settings.
void addSettings(std::vector<OtherImage>& images) {
  for (OtherImage& image : images) {
    const std::string file = image.snapshot.image.string();
    if (extensionOf(file) == ".exr") image.settings = seriesSettings(readImage(file).metadata);
  }
}

// ---- names ----------------------------------------------------------------------------------------------------------

bool isLightImage(const fs::path& file) {
  constexpr std::array<std::string_view, 3> kExtensions{".exr", ".pfm", ".hdr"};
  return std::find(kExtensions.begin(), kExtensions.end(), file.extension().string()) != kExtensions.end();
}

// What an image that wavecrest rendered says of itself. Nothing if it is of another program.
std::optional<OtherImage> describedImage(const fs::path& file, const std::string& scene) {
  const Metadata metadata = readImage(file.string()).metadata;
  const auto value = [&](const char* key) { return attributeOf(metadata, key); };
  const std::optional<double> seconds = wholeNumber<double>(value("render_seconds"));
  if (value("method").empty() || !seconds) return std::nullopt;
  const std::string own = fs::path(value("scene")).stem().string();
  return OtherImage{
      .scene = own.empty() ? scene : own,
      .method = value("method"),
      .sceneHash = value("scene_hash"),
      .seed = wholeNumber<uint64_t>(value("seed")).value_or(0),
      .settings = seriesSettings(metadata),
      .snapshot = {
          .seconds = *seconds, .iterations = wholeNumber<uint64_t>(value("iterations")).value_or(0), .image = file}};
}

// Whether an image is one of the runs', or of the same render as one.
bool belongsTo(std::span<const RunFile> known, const fs::path& file) {
  return std::any_of(known.begin(), known.end(), [&](const RunFile& run) {
    if (fs::path(run.path).replace_extension(file.extension()) == file) return true;
    return std::any_of(run.snapshots.begin(), run.snapshots.end(),
                       [&](const SnapshotFile& snapshot) { return snapshot.image.filename() == file.filename(); });
  });
}

}  // namespace

std::vector<RunFile> readListedRuns(const fs::path& list, const std::string& scene) {
  std::ifstream file(list);
  if (!file) throw ResultsError(list.string() + ": cannot be read; expected a list of images");
  std::vector<Column> columns;
  std::vector<OtherImage> images;
  std::string text;
  for (size_t line = 1; std::getline(file, text); ++line) {
    if (line == 1 && text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // the mark of UTF-8
    const std::vector<std::string> fields = fieldsOf(text);
    if (fields.size() == 1 && fields.front().empty()) continue;
    // The first line may name the columns.
    if (columns.empty()) {
      columns = columnsOf(list, line, fields);
      if (!columns.empty()) continue;
      columns = {Column::image, Column::seconds};
    }
    images.push_back(readRow(list, line, columns, fields, scene));
  }
  if (images.empty())
    throw ResultsError(list.string() + ": names no image; expected an image and seconds on each line");
  nameMethods(images, list.parent_path());
  addSettings(images);
  return runsOf(images);
}

std::vector<RunFile> readNamedRuns(const fs::path& folder, const std::string& scene, std::span<const RunFile> known) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (isLightImage(entry.path()) && !isReferenceFile(entry.path()) && !belongsTo(known, entry.path())) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());  // a folder lists files in any order
  std::vector<OtherImage> images;
  for (const fs::path& file : files) {
    // Beside stats files, what wavecrest rendered without one is a leftover.
    if (const auto own = describedImage(file, scene)) {
      if (known.empty()) images.push_back(*own);
      continue;
    }
    const std::optional<TimedName> name = timedName(file.stem().string());
    if (name) {
      images.push_back({.scene = scene,
                        .method = name->method,
                        .sceneHash = {},
                        .seed = 0,
                        .snapshot = {.seconds = name->seconds, .iterations = 0, .image = file}});
    } else if (known.empty()) {
      throw ResultsError(file.string() + ": its name has no render time; expected METHOD.SECONDS.exr, or a line in " +
                         kImageList);
    }
  }
  return runsOf(images);
}

}  // namespace wavecrest

// Renders of the interface.
#include "wavecrest/render.h"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "bench/campaign/render_stats.h"
#include "bench/film_image.h"
#include "bench/json_text.h"
#include "engine/scene/scene_error.h"
#include "engine/session/session.h"
#include "library/render_settings.h"
#include "library/scene_data.h"
#include "library/translate.h"
#include "metrics/image/image_io.h"
#include "wavecrest/error.h"

namespace wavecrest::api {
namespace {

// What was approximated or left out when the scene was loaded, in the words of `wavecrest render`.
nlohmann::ordered_json loadingNotes(const wavecrest::Scene& scene) {
  nlohmann::ordered_json notes = scene.warnings;
  for (const Note& note : scene.notes) notes.push_back(toString(note));
  return notes;
}

}  // namespace

struct Render::Data {
  std::shared_ptr<const Scene::Data> scene;
  RenderSettings settings;
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  std::unique_ptr<Session> session;

  wavecrest::Image wholeImage() const {
    if (session->statistics().hasWholeImage()) return filmImage(*session);
    throw Error(ErrorKind::input,
                fmt::format("render: no whole pass over the film after {:.2g} s; expected a longer time",
                            session->progressSeconds()));
  }
  nlohmann::ordered_json stats() const {
    const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const RenderStatistics statistics = session->statistics();
    nlohmann::ordered_json all = renderStats(scene->scene, settings, statistics, scene->loadSeconds, wall, {});
    if (!settings.measureStages) all.erase("stages");
    all["notes"] = loadingNotes(scene->scene);
    all["decisions"] = decisionsJson(scene->scene, settings, statistics);
    return all;
  }
};

Render::Render(const Scene& scene, const RenderOptions& options) {
  translated([&] {
    auto data = std::make_unique<Data>();
    data->scene = scene.data_;
    data->settings = renderSettings(options, data->scene->scene);
    data->session = Session::create(data->scene->scene, data->settings);
    data_ = std::move(data);
  });
}
Render::~Render() = default;
Render::Render(Render&&) noexcept = default;
Render& Render::operator=(Render&&) noexcept = default;

void Render::run() { runUntil(data_->settings.seconds, data_->settings.iterations); }

void Render::runUntil(std::optional<double> seconds, std::optional<uint64_t> iterations) {
  translated([&] { data_->session->renderUntil(iterations, seconds); });
}

void Render::stop() noexcept { data_->session->interrupt(); }
bool Render::stopped() const noexcept { return data_->session->interrupted(); }

double Render::seconds() const { return data_->session->progressSeconds(); }
uint64_t Render::iterations() const { return data_->session->statistics().iterations; }

Image Render::image() const {
  return translated([&]() -> Image {
    wavecrest::Image image = data_->wholeImage();
    return {.width = image.width, .height = image.height, .pixels = std::move(image.pixels)};
  });
}

std::string Render::stats() const {
  return translated([&] { return jsonText(data_->stats()); });
}

void Render::write(const std::string& file) const {
  translated([&] {
    checkImageTarget(file);
    writeImage(file, data_->wholeImage(), statsMetadata(data_->stats()));
  });
}

}  // namespace wavecrest::api

// The reference that a scene's runs are measured against: one that exists, or one that the campaign renders itself.
#pragma once

#include <functional>
#include <stdexcept>

#include "bench/campaign/campaign_settings.h"
#include "bench/campaign/render_reference.h"

namespace wavecrest {

// A reference that is asked for and cannot be used. The text is complete.
struct ReferenceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Leaves the reference in out/references/SCENE.exr and returns it: a copy of referenceFolder/SCENE.exr where that is of
// this scene in this size; else it is rendered, or the next call goes on rendering it. Where references are required,
// or other shards would render other ones, that is a ReferenceError instead. Waits while another shard renders the same
// one. hooks.stopped() tells an unfinished one.
Reference sceneReference(const Scene& scene, const CampaignScene& entry, const CampaignSettings& settings,
                         const ReferenceHooks& hooks, const std::function<void(const std::string&)>& say);

// Whether sceneReference will take one that exists; else it will render one, for so much longer than a run. Throws the
// same ReferenceError, so that a campaign can find out before its first run.
bool referenceExists(const Scene& scene, const CampaignScene& entry, const CampaignSettings& settings);

// A reference's noise must be far below the errors it measures: variance below a tenth (METHODS 8.4), as a method that
// suits the scene is as good after a tenth of the reference's time.
constexpr double kReferenceEffort = 12;

// Where it lies, relative to the campaign's folder.
std::filesystem::path referenceFile(const std::string& scene);

}  // namespace wavecrest

// What a scene handle of the interface holds.
#pragma once

#include "engine/scene/scene.h"
#include "wavecrest/scene.h"

namespace wavecrest::api {

struct Scene::Data {
  wavecrest::Scene scene;
  double loadSeconds = 0;
};

}  // namespace wavecrest::api

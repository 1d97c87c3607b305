#include "engine/methods/method_list.h"

namespace wavecrest {

std::string methodChoices() {
  std::string choices;
  for (const MethodEntry& entry : kMethods) choices += (choices.empty() ? "" : ", ") + std::string(entry.name);
  return choices;
}

MethodPage pageOf(Method method, MetropolisVariant variant, bool directPass) {
  if (method == Method::mlt && variant == MetropolisVariant::pssmlt) return primarySampleSpace();
  if (method == Method::mlt && variant == MetropolisVariant::pathspace) return pathSpaceMetropolis();
  if (method == Method::ppm && directPass) return photonMappingWithDirectPass();
  return entryOf(method).page();
}

}  // namespace wavecrest

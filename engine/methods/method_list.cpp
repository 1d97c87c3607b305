#include "engine/methods/method_list.h"

namespace wavecrest {

std::string methodChoices() {
  std::string choices;
  for (const MethodEntry& entry : kMethods) choices += (choices.empty() ? "" : ", ") + std::string(entry.name);
  return choices;
}

MethodPage pageOf(Method method, MetropolisVariant variant) {
  if (method == Method::mlt && variant == MetropolisVariant::pssmlt) return primarySampleSpace();
  if (method == Method::mlt && variant == MetropolisVariant::pathspace) return pathSpaceMetropolis();
  return entryOf(method).page();
}

}  // namespace wavecrest

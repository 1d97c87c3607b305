// The list of light-transport methods: the name that --method takes, and the pipeline.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "engine/pipeline.h"

namespace wavecrest {

enum class Method { pt };

struct MethodEntry {
  Method method;
  std::string_view name;         // spelling of --method
  std::string_view description;  // one line
};

constexpr std::array kMethods{
    MethodEntry{Method::pt, "pt", "path tracing with next event estimation"},
};

constexpr std::optional<Method> parseMethod(std::string_view word) {
  for (const MethodEntry& entry : kMethods) {
    if (entry.name == word) return entry.method;
  }
  return std::nullopt;
}
constexpr std::string_view toString(Method method) { return kMethods[static_cast<size_t>(method)].name; }

// Each method's pipeline, in a file of its own.
template <class S>
Pipeline<S> pathTracing(const Stages<S>& stages, const Intersector<S>& intersector);

}  // namespace wavecrest

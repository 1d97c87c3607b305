// The machine and the program that results come from.
#pragma once

#include <map>
#include <string>

#include "engine/plan/render_settings.h"

namespace wavecrest {

// version, commit, cpu, host, isa, threads: keys of the results file's campaign table.
std::map<std::string, std::string> environment(const RenderSettings& settings);

}  // namespace wavecrest

#include "wavecrest/results.h"

namespace wavecrest {

std::string_view toString(RunState state) { return state == RunState::done ? "done" : "refused"; }

void addDistinct(std::string& list, const std::string& value) {
  if (list.empty()) {
    list = value;
  } else if ((", " + list + ", ").find(", " + value + ", ") == std::string::npos) {
    list += ", " + value;
  }
}

}  // namespace wavecrest

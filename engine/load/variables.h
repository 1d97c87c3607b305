// The $name variables of a scene file: <default> values and -D definitions.
//
// Follows Mitsuba 3: definitions given from outside win over <default>, the first <default> of a name wins over later
// ones, `\$` is a literal dollar, and where several names match at a dollar the longest does.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/load/load.h"

namespace wavecrest {

class Variables {
 public:
  explicit Variables(const std::map<std::string, std::string>& defines);

  void setDefault(std::string_view name, std::string_view value, const SourceLocation& where);
  std::string substitute(std::string_view text, const SourceLocation& where);
  // Names of outside definitions that nothing used.
  std::vector<std::string> unusedDefines() const;

 private:
  struct Variable {
    std::string value;
    bool fromOutside = false, used = false;
  };
  std::map<std::string, Variable, std::less<>> variables_;
  size_t longestName_ = 0;
  size_t substitutedBytes_ = 0;  // of all values so far
};

}  // namespace wavecrest

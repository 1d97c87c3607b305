#include "engine/load/variables.h"

#include <algorithm>

namespace wavecrest {

namespace {

// A chain of <default>s that each contain the previous one twice doubles at every step. No honest scene comes near.
constexpr size_t kMostSubstituted = 1 << 24;
// substitute() tries every length up to that of the longest name, so names in a file must be short.
constexpr size_t kLongestName = 256;

// For error messages only: the name of a variable may contain any character.
bool isNameCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

}  // namespace

// Definitions from outside are entered first, so that setDefault cannot replace them.
Variables::Variables(const std::map<std::string, std::string>& defines) {
  for (const auto& [name, value] : defines) {
    variables_[name] = {.value = value, .fromOutside = true, .used = false};
    longestName_ = std::max(longestName_, name.size());
  }
}

void Variables::setDefault(std::string_view name, std::string_view value, const SourceLocation& where) {
  if (name.empty()) throw LoadError(where, "<default> has an empty name; expected the name of a variable");
  if (name.size() > kLongestName) {
    throw LoadError(where,
                    "name of a variable has " + std::to_string(name.size()) + " characters; expected at most 256");
  }
  longestName_ = std::max(longestName_, name.size());
  // try_emplace keeps an existing value: a definition from outside, or an earlier <default>.
  variables_.try_emplace(std::string(name), Variable{.value = std::string(value)});
}

std::string Variables::substitute(std::string_view text, const SourceLocation& where) {
  std::string result;
  for (size_t i = 0; i < text.size();) {
    // Copy escaped dollars and plain text.
    if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] == '$') {
      result += '$';
      i += 2;
      continue;
    }
    if (text[i] != '$') {
      result += text[i++];
      continue;
    }
    // At a dollar: find the longest variable name that the text goes on with.
    const std::string_view rest = text.substr(i + 1);
    auto found = variables_.end();
    for (size_t length = std::min(longestName_, rest.size()); length > 0 && found == variables_.end(); --length) {
      found = variables_.find(rest.substr(0, length));
    }
    if (found == variables_.end()) {
      // No name matches. The message quotes the letters, digits and underscores after the dollar.
      const size_t end =
          static_cast<size_t>(std::find_if_not(rest.begin(), rest.end(), isNameCharacter) - rest.begin());
      const std::string name(rest.substr(0, end));
      throw LoadError(where, "undefined variable $" + name + "; expected a <default name=\"" + name +
                                 "\"> above this line or -D " + name + "=…");
    }
    // Insert the value, which is not searched for dollars again.
    found->second.used = true;
    result += found->second.value;
    i += 1 + found->first.size();
    substitutedBytes_ += found->second.value.size();
    if (substitutedBytes_ > kMostSubstituted) {
      throw LoadError(where, "variables expand to more than 16 MiB of text; expected fewer or shorter values");
    }
  }
  return result;
}

std::vector<std::string> Variables::unusedDefines() const {
  std::vector<std::string> names;
  for (const auto& [name, variable] : variables_) {
    if (variable.fromOutside && !variable.used) names.push_back(name);
  }
  return names;
}

}  // namespace wavecrest

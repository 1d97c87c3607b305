// Options that an environment variable can set as well, for users who want the same value in every call.
#pragma once

namespace wavecrest {

struct OptionVariable {
  const char *option, *variable;  // the option by its long name
};
inline constexpr OptionVariable kVariables[] = {
    {"--threads", "WAVECREST_THREADS"},   {"--isa", "WAVECREST_ISA"},       {"--precision", "WAVECREST_PRECISION"},
    {"--progress", "WAVECREST_PROGRESS"}, {"--memory", "WAVECREST_MEMORY"}, {"--sampler", "WAVECREST_SAMPLER"},
    {"--method", "WAVECREST_METHOD"},     {"--size", "WAVECREST_SIZE"},     {"--seed", "WAVECREST_SEED"}};

}  // namespace wavecrest

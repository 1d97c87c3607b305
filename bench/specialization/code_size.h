// How many bytes of machine code a program has for a feature set's kernels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "kernels/stages.h"

namespace wavecrest {

// Functions of an instruction set that were instantiated for this precision and these features, from the symbol table
// of an ELF file's bytes. What kernels of several feature sets share is not in it. Nothing if the file has no symbols
// (stripped) or is no 64-bit ELF.
std::optional<uint64_t> codeBytes(std::span<const unsigned char> file, Isa isa, Precision precision, uint32_t features);

}  // namespace wavecrest

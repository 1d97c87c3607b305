#include "bench/specialization/code_size.h"

#include <elf.h>
#include <fmt/format.h>

#include <cstring>
#include <string_view>

namespace wavecrest {
namespace {

// The bytes as a T, or nothing where the file ends before.
template <class T>
std::optional<T> readAt(std::span<const unsigned char> file, uint64_t offset) {
  if (offset > file.size() || file.size() - offset < sizeof(T)) return std::nullopt;
  T value;
  std::memcpy(&value, file.data() + offset, sizeof(T));
  return value;
}

std::optional<Elf64_Shdr> section(std::span<const unsigned char> file, const Elf64_Ehdr& header, uint32_t index) {
  return readAt<Elf64_Shdr>(file, header.e_shoff + uint64_t{index} * header.e_shentsize);
}

std::string_view nameAt(std::span<const unsigned char> file, const Elf64_Shdr& names, uint32_t offset) {
  if (offset >= names.sh_size || names.sh_offset > file.size() || file.size() - names.sh_offset < names.sh_size)
    return {};
  const char* const begin = reinterpret_cast<const char*>(file.data() + names.sh_offset + offset);
  return {begin, strnlen(begin, names.sh_size - offset)};
}

// Names of namespaces and policies as the compiler writes them into symbols (Itanium C++ ABI, 5.1).
std::string_view mangledNamespace(Isa isa) {
  constexpr std::array<std::string_view, kAllIsas.size()> kNames{"8N_SCALAR", "6N_SSE4", "6N_AVX2", "6N_AVX3"};
  return kNames[static_cast<size_t>(isa)];
}
std::string_view mangledPolicy(Precision precision) {
  constexpr std::array<std::string_view, 2> kNames{"14FloatPrecision", "15DoublePrecision"};
  return kNames[static_cast<size_t>(arithmeticOf(precision))];
}

}  // namespace

std::optional<uint64_t> codeBytes(std::span<const unsigned char> file, Isa isa, Precision precision,
                                  uint32_t features) {
  const auto header = readAt<Elf64_Ehdr>(file, 0);
  if (!header || std::memcmp(header->e_ident, ELFMAG, SELFMAG) != 0 || header->e_ident[EI_CLASS] != ELFCLASS64) {
    return std::nullopt;
  }
  const std::string instantiation = fmt::format("{}ELj{}E", mangledPolicy(precision), features);
  std::optional<uint64_t> bytes;
  for (uint32_t i = 0; i < header->e_shnum; ++i) {
    const auto table = section(file, *header, i);
    if (!table || table->sh_type != SHT_SYMTAB) continue;
    const auto names = section(file, *header, table->sh_link);
    if (!names) continue;
    bytes = 0;
    for (uint64_t at = 0; at + sizeof(Elf64_Sym) <= table->sh_size; at += sizeof(Elf64_Sym)) {
      const auto symbol = readAt<Elf64_Sym>(file, table->sh_offset + at);
      if (!symbol) break;
      if (ELF64_ST_TYPE(symbol->st_info) != STT_FUNC) continue;
      const std::string_view name = nameAt(file, *names, symbol->st_name);
      const bool ours = name.find(mangledNamespace(isa)) != name.npos && name.find(instantiation) != name.npos;
      if (ours) *bytes += symbol->st_size;
    }
  }
  return bytes;
}

}  // namespace wavecrest

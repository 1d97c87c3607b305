// Records word by word, for kernels that look few of them up in registers.
#pragma once

#include <cstring>
#include <memory>
#include <span>

#include "kernels/scene_view.h"

namespace wavecrest {

// None if the records are too many for that.
template <class Table, class Record>
std::unique_ptr<Table> tabulate(std::span<const Record> records) {
  if (records.size() > Table::kRecords) return nullptr;
  auto table = std::make_unique<Table>();
  for (size_t record = 0; record < records.size(); ++record) {
    uint32_t words[Table::kWords];
    static_assert(sizeof(words) <= sizeof(Record));
    std::memcpy(words, &records[record], sizeof(words));
    for (size_t w = 0; w < Table::kWords; ++w) table->words[w][record] = words[w];
  }
  return table;
}

}  // namespace wavecrest

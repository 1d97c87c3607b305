#include "bench/report/write_report.h"

#include <string>

#include "bench/report/collect.h"
#include "bench/report/html_page.h"
#include "metrics/image/atomic_file.h"

namespace wavecrest {

std::filesystem::path writeReport(const std::filesystem::path& folder) {
  const std::string page = renderReport(collectReport(folder));
  std::filesystem::path path = folder / "report.html";
  writeFileAtomically(path.string(), {reinterpret_cast<const unsigned char*>(page.data()), page.size()});
  return path;
}

}  // namespace wavecrest

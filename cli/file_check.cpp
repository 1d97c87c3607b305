#include "cli/file_check.h"

#include <fmt/core.h>

#include "cli/commands.h"
#include "cli/messages.h"
#include "metrics/image/atomic_file.h"
#include "metrics/image/image.h"
#include "metrics/image/image_io.h"
#include "metrics/image/real_name.h"

namespace wavecrest {

namespace fs = std::filesystem;

void FileCheck::add(const Use& use, const fs::path& file) {
  if (file == kStandardStream && !use.written) return;  // stdin is not stdout
  const fs::path name = file == kStandardStream ? file : realName(file);
  std::error_code ignored;
  if (fs::is_character_file(name, ignored)) return;  // /dev/null takes any number of outputs
  const auto [known, first] = uses_.emplace(name, use);
  if (first || (!use.written && !known->second.written)) return;
  const Use& output = use.written ? use : known->second;
  const Use& other = use.written ? known->second : use;
  throw UsageError(
      fmt::format("{} {}: is the file of {} too; expected a file of its own", output.role, file.string(), other.role));
}

void FileCheck::input(const std::string& role, const fs::path& file) { add({role, false}, file); }
void FileCheck::laterOutput(const std::string& role, const fs::path& file) { add({role, true}, file); }

void FileCheck::output(const std::string& role, const fs::path& file) {
  laterOutput(role, file);
  if (file == kStandardStream) return;
  try {
    checkWritable(file.string());
  } catch (const ImageError& error) {
    throw UsageError(fmt::format("{} {}", role, error.what()));
  }
}

void FileCheck::image(const std::string& role, const fs::path& file) {
  try {
    checkImageTarget(file.string());
  } catch (const ImageError& error) {
    throw UsageError(error.what());
  }
  output(role, file);
}

void FileCheck::reference(const std::string& role, const fs::path& file) {
  if (file.extension() != ".exr") {
    throw UsageError(
        fmt::format("{} {}: expected a name that ends in .exr, which keeps the halves", role, file.string()));
  }
  output(role, file);
}

void writeText(const std::string& file, const std::string& text) {
  if (file != kStandardStream) {
    writeFileAtomically(file, text);
    return;
  }
  writeStdout(text);
  const std::string failure = takeStdoutFailure();
  if (!failure.empty()) throw ImageError(failure);
}

}  // namespace wavecrest

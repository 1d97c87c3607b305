// Runs `wavecrest compare` inside the test process: the same command object that main() registers.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "metrics/image/image.h"

namespace wavecrest::test {

struct CompareRun {
  int exitCode = kExitFailure;
  std::string output, error;  // stdout; stderr or the text of the exception that main() would print
  nlohmann::json json() const { return nlohmann::json::parse(output); }
};

inline CompareRun runCompare(std::vector<std::string> arguments) {
  CompareRun run;
  CommandLine program("", "wavecrest");
  addCompareCommand(program, run.exitCode);
  arguments.insert(arguments.begin(), "compare");
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  std::string thrown;
  try {
    program.parse(arguments, run.exitCode);
  } catch (const UsageError& error) {
    run.exitCode = kExitUsage;
    thrown = error.what();
  } catch (const ImageError& error) {
    run.exitCode = kExitInput;
    thrown = error.what();
  }
  run.output = ::testing::internal::GetCapturedStdout();
  run.error = ::testing::internal::GetCapturedStderr() + thrown;
  return run;
}

}  // namespace wavecrest::test

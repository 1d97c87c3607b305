// What the subcommands share: registration, exit codes, errors.
//
// Each command adds itself to the app with a callback that runs it and may set the exit code; errors leave a callback
// as exceptions, and main() turns them into one line on stderr and the exit code of their kind.
#pragma once

#include <stdexcept>

#include "cli/command_line.h"

namespace wavecrest {

enum ExitCode : int {
  kExitDone = 0,
  kExitFailure = 1,       // a fault of ours
  kExitUsage = 2,         // wrong options
  kExitInput = 3,         // a scene, image or checkpoint that cannot be used
  kExitCheck = 4,         // a check that was asked for did not hold
  kExitInterrupted = 130  // after saving
};

struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void addCompareCommand(CommandLine& program, int& exitCode);
void addBenchCommand(CommandLine& program, int& exitCode);
void addInspectCommand(CommandLine& program, int& exitCode);
void addConvertCommand(CommandLine& program, int& exitCode);
void addConvergeCommand(CommandLine& program, int& exitCode);
void addDescribeCommand(CommandLine& program, int& exitCode);
void addRecommendCommand(CommandLine& program, int& exitCode);
void addReferenceCommand(CommandLine& program, int& exitCode);
void addRenderCommand(CommandLine& program, int& exitCode);
void addReportCommand(CommandLine& program, int& exitCode);
void addScenesCommand(CommandLine& program, int& exitCode);

}  // namespace wavecrest

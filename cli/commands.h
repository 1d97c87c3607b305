// The subcommands: each adds itself to the program with a callback that runs it and may set the exit code. Errors leave
// a callback as exceptions (library/errors.h), and main() turns them into one line on stderr and the exit code of their
// kind.
#pragma once

#include "cli/command_line.h"
#include "library/errors.h"

namespace wavecrest {

void addCompareCommand(CommandLine& program, int& exitCode);
void addBenchCommand(CommandLine& program, int& exitCode);
void addInspectCommand(CommandLine& program, int& exitCode);
void addConvertCommand(CommandLine& program, int& exitCode);
void addConvergeCommand(CommandLine& program, int& exitCode);
void addDescribeCommand(CommandLine& program, int& exitCode);
void addMergeCommand(CommandLine& program, int& exitCode);
void addRecommendCommand(CommandLine& program, int& exitCode);
void addReferenceCommand(CommandLine& program, int& exitCode);
void addRenderCommand(CommandLine& program, int& exitCode);
void addReportCommand(CommandLine& program, int& exitCode);
void addScenesCommand(CommandLine& program, int& exitCode);

}  // namespace wavecrest

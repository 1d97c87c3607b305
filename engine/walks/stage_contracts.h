// What every stage may rely on and must leave behind. Checked only while checksContracts is set, as in contracts_test.
//
// Queues fit their memory, counts agree with each other, indices lead to something, directions are unit vectors, and no
// number is NaN. Columns.h and kernels/stages.h say the contracts in words; this is the one place that tests them, so
// that kernels stay free of it, and each instruction set and specialisation is tested alike.
#pragma once

#include <atomic>
#include <string_view>

#include "kernels/stages.h"

namespace wavecrest {

// Whether walks check the contracts around each of their stages. To be changed while no session renders.
inline std::atomic<bool> checksContracts{false};

// Ends the program with a line that names the stage and what does not hold.
template <class S>
void requireBefore(std::string_view stage, const StageContext<S>& context, const Wave<S>& wave);
template <class S>
void requireAfter(std::string_view stage, const StageContext<S>& context, const Wave<S>& wave);

// The same answer as a test can ask for it: what does not hold, or nothing.
template <class S>
std::string_view brokenContract(std::string_view stage, const StageContext<S>& context, const Wave<S>& wave);

}  // namespace wavecrest

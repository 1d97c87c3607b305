// Whose fault an exception is: the one list that the library's errors and the program's exit codes follow.
#include "wavecrest/error.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>
#include <typeinfo>

#include "bench/campaign/file_lock.h"
#include "bench/campaign/reference_agreement.h"
#include "bench/campaign/render_reference.h"
#include "bench/campaign/scene_reference.h"
#include "bench/checkpoint/checkpoint.h"
#include "bench/report/results_folder.h"
#include "bench/results/results_error.h"
#include "engine/plan/memory_use.h"
#include "library/errors.h"
#include "library/translate.h"
#include "metrics/image/image.h"
#include "scenes/scene_list.h"

namespace wavecrest {
namespace {

// As the library throws it.
template <class Exception>
api::Error leavingAs(const Exception& exception) {
  try {
    translated([&] { throw exception; });
  } catch (const api::Error& error) {
    return error;
  }
  ADD_FAILURE() << "nothing was thrown";
  return {api::ErrorKind::fault, ""};
}

template <class Exception>
void expectInput() {
  const api::Error error = leavingAs(Exception("a.exr: is damaged; expected another"));
  EXPECT_EQ(error.kind(), api::ErrorKind::input) << typeid(Exception).name();
  EXPECT_STREQ(error.what(), "a.exr: is damaged; expected another");
}

TEST(LibraryError, filesThatCannotBeUsedAreTheInputsFault) {
  expectInput<InputError>();
  expectInput<ImageError>();
  expectInput<CheckpointError>();
  expectInput<SceneFolderError>();
  expectInput<ReferenceError>();
  expectInput<ReferenceMismatch>();
  expectInput<ReferenceComparisonError>();
  expectInput<FileLockError>();
  expectInput<ResultsError>();
  expectInput<ResultsFileError>();
}

TEST(LibraryError, aBudgetThatIsTooSmallIsAWrongOption) {
  const api::Error error = leavingAs(MemoryBudgetError("is too small"));
  EXPECT_EQ(error.kind(), api::ErrorKind::usage);
  EXPECT_STREQ(error.what(), "--memory: is too small");
}

TEST(LibraryError, whatNobodyAskedForIsAFault) {
  EXPECT_EQ(leavingAs(std::bad_alloc()).kind(), api::ErrorKind::fault);
  EXPECT_EQ(leavingAs(std::logic_error("never")).kind(), api::ErrorKind::fault);
}

}  // namespace
}  // namespace wavecrest

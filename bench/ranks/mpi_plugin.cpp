// libwavecrest_mpi.so: the only file that knows MPI.
#include "bench/ranks/mpi_plugin.h"

#include <mpi.h>

#include <limits>

namespace wavecrest {
namespace {

MPI_Comm world = MPI_COMM_NULL;  // of the program's own, so that its messages meet no others
MPI_Datatype block = MPI_DATATYPE_NULL;
constexpr int kTag = 1;

bool failed(int code) { return code != MPI_SUCCESS; }
bool tooMany(uint64_t blocks) { return blocks > static_cast<uint64_t>(std::numeric_limits<int>::max()); }

int start(int* rank, int* ranks) {
  int provided = 0;
  // Other threads run as well, but this one alone calls MPI.
  if (failed(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided))) return -1;
  // Errors are returned: a process that is lost must not end the others before they have saved.
  if (failed(MPI_Comm_dup(MPI_COMM_WORLD, &world)) || failed(MPI_Comm_set_errhandler(world, MPI_ERRORS_RETURN)) ||
      failed(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN)) ||
      failed(MPI_Type_contiguous(static_cast<int>(kMpiBlock), MPI_BYTE, &block)) || failed(MPI_Type_commit(&block)) ||
      failed(MPI_Comm_rank(world, rank)) || failed(MPI_Comm_size(world, ranks))) {
    return -1;
  }
  return 0;
}

int send(int to, const void* bytes, uint64_t blocks, void** request) {
  if (tooMany(blocks)) return -1;
  auto* const own = new MPI_Request;
  if (failed(MPI_Isend(bytes, static_cast<int>(blocks), block, to, kTag, world, own))) {
    delete own;
    return -1;
  }
  *request = own;
  return 0;
}

int over(void** request) {
  auto* const own = static_cast<MPI_Request*>(*request);
  int done = 0;
  const bool wrong = failed(MPI_Test(own, &done, MPI_STATUS_IGNORE));
  if (!wrong && done == 0) return 0;
  delete own;
  *request = nullptr;
  return wrong ? -1 : 1;
}

int arrived(int* from, uint64_t* blocks) {
  int there = 0, count = 0;
  MPI_Status status;
  if (failed(MPI_Iprobe(MPI_ANY_SOURCE, kTag, world, &there, &status))) return -1;
  if (there == 0) return 0;
  if (failed(MPI_Get_count(&status, block, &count)) || count < 0) return -1;
  *from = status.MPI_SOURCE;
  *blocks = static_cast<uint64_t>(count);
  return 1;
}

int receive(int from, void* bytes, uint64_t blocks, void** request) {
  if (tooMany(blocks)) return -1;
  auto* const own = new MPI_Request;
  if (failed(MPI_Irecv(bytes, static_cast<int>(blocks), block, from, kTag, world, own))) {
    delete own;
    return -1;
  }
  *request = own;
  return 0;
}

int finish() {
  MPI_Type_free(&block);
  MPI_Comm_free(&world);
  return failed(MPI_Finalize()) ? -1 : 0;
}

constexpr MpiFunctions kFunctions{kMpiPluginVersion, start, send, over, arrived, receive, finish};

}  // namespace
}  // namespace wavecrest

// The symbol that the program looks for, with the library's name before it as C has it.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" __attribute__((visibility("default"))) const wavecrest::MpiFunctions* wavecrest_mpi();
const wavecrest::MpiFunctions* wavecrest_mpi() { return &wavecrest::kFunctions; }
// NOLINTEND(readability-identifier-naming)

// What the program asks of MPI, as functions of a library of its own (mpi_plugin.cpp) that is loaded at run time.
//
// In C, so that the library may be built with any compiler and any MPI. All functions are to be called from one thread,
// the one that called start. Messages are whole blocks of kMpiBlock bytes, whose number fits an int for up to 128 GB.
// Functions return 0 or more, and less than 0 where MPI reports an error.
#pragma once

#include <cstdint>

namespace wavecrest {

constexpr uint64_t kMpiBlock = 64;
// Of the functions below. A library of another version is not used.
constexpr int kMpiPluginVersion = 2;

struct MpiFunctions {
  int version;
  // Begins; rank: the number of this process among `ranks`.
  int (*start)(int* rank, int* ranks);
  // Begins to send; the bytes must stay until the request is over.
  int (*send)(int to, const void* bytes, uint64_t blocks, void** request);
  // 1: the message is sent, or received; 0: not yet. Unless it is 0, the request is gone.
  int (*over)(void** request);
  // 1: a message can be received; 0: none.
  int (*arrived)(int* from, uint64_t* blocks);
  // Begins to receive the next message from there, of so many blocks; its first bytes may be all that has arrived. The
  // bytes must stay until the request is over.
  int (*receive)(int from, void* bytes, uint64_t blocks, void** request);
  // Waits for all processes to call it. No other function may be called any more.
  int (*finish)();
};

// The one symbol of the library: const MpiFunctions* wavecrest_mpi().
constexpr const char* kMpiPluginSymbol = "wavecrest_mpi";

}  // namespace wavecrest

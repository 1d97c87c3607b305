#include "bench/ranks/mailbox.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <utility>

#include "bench/ranks/mpi_library.h"

namespace wavecrest {
namespace {

using Clock = std::chrono::steady_clock;
// Between two looks: where nothing is under way, and where something is.
constexpr auto kPause = std::chrono::milliseconds(3);
constexpr auto kShortPause = std::chrono::microseconds(50);
constexpr auto kTick = std::chrono::milliseconds(10);
// For what was posted before an end without finish.
constexpr auto kLastMoment = std::chrono::milliseconds(300);

// A message in whole blocks: itself, what fills the last block, and its length.
std::vector<unsigned char> inBlocks(std::vector<unsigned char> message) {
  const uint64_t length = message.size();
  const uint64_t blocks = (length + sizeof(length) + kMpiBlock - 1) / kMpiBlock;
  message.resize(blocks * kMpiBlock);
  std::memcpy(message.data() + message.size() - sizeof(length), &length, sizeof(length));
  return message;
}

// Back; empty where the length is none.
std::vector<unsigned char> fromBlocks(std::vector<unsigned char> bytes) {
  uint64_t length = 0;
  if (bytes.size() < sizeof(length)) return {};
  std::memcpy(&length, bytes.data() + bytes.size() - sizeof(length), sizeof(length));
  if (length > bytes.size() - sizeof(length)) return {};
  bytes.resize(length);
  return bytes;
}

}  // namespace

Mailbox::Mailbox(const MpiFunctions& mpi) : mpi_(mpi), thread_([this] { run(); }) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return started_ || failed_; });
  if (!failed_) return;
  lock.unlock();
  thread_.join();
  throw RanksError("MPI cannot be started");
}

Mailbox::~Mailbox() { abandon(); }

void Mailbox::open(Duties duties) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    duties_ = std::move(duties);
  }
  changed_.notify_all();
}

void Mailbox::post(uint32_t to, Bytes message) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    posted_.push_back({to, std::move(message)});
  }
  changed_.notify_all();
}

void Mailbox::finish() { end(Ending::finish); }

void Mailbox::abandon() { end(Ending::abandon); }

void Mailbox::end(Ending ending) {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = ending;
  }
  changed_.notify_all();
  thread_.join();
}

void Mailbox::run() {
  int rank = 0, ranks = 0;
  const bool works = mpi_.start(&rank, &ranks) >= 0;
  {
    std::unique_lock<std::mutex> lock(mutex_);
    rank_ = static_cast<uint32_t>(rank);
    ranks_ = static_cast<uint32_t>(ranks);
    (works ? started_ : failed_) = true;
    changed_.notify_all();
    if (!works) return;
    // Nothing is received before somebody takes it.
    changed_.wait(lock, [this] { return duties_.received != nullptr || ending_ != Ending::none; });
  }
  work();
}

void Mailbox::work() {
  Clock::time_point lastTick = Clock::now(), giveUp = Clock::time_point::max();
  for (;;) {
    const bool sent = sendPosted(Recipients::all), received = duties_.received && receiveAll();
    if (duties_.tick && Clock::now() - lastTick >= kTick) {
      lastTick = Clock::now();
      guarded([&] { duties_.tick(); });
    }
    std::unique_lock<std::mutex> lock(mutex_);
    if (!posted_.empty()) continue;
    const bool idle = underWay_.empty() && arriving_.empty();
    if (ending_ == Ending::finish && idle) {
      lock.unlock();
      mpi_.finish();
      return;
    }
    if (ending_ == Ending::abandon) {
      if (giveUp == Clock::time_point::max()) giveUp = Clock::now() + kLastMoment;
      if (underWay_.empty() || Clock::now() > giveUp) {
        lock.unlock();
        leaveToMpi();
        return;
      }
    }
    if (sent || received) continue;
    if (idle) {
      changed_.wait_for(lock, kPause);
    } else {
      lock.unlock();
      std::this_thread::sleep_for(kShortPause);
    }
  }
}

// Runs a step that may throw, as where memory is short: an exception that left the thread would end the process before
// it has saved anything.
template <class Step>
void Mailbox::guarded(Step step) {
  try {
    step();
  } catch (const std::exception& error) {
    if (duties_.failed) duties_.failed(error);
  }
}

void Mailbox::sendNow() { sendPosted(Recipients::others); }

// The first letter that was posted to one of the recipients.
std::optional<Mailbox::Letter> Mailbox::takePosted(Recipients recipients) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto first = std::find_if(posted_.begin(), posted_.end(), [&](const Letter& letter) {
    return recipients == Recipients::all || letter.other != rank_;
  });
  if (first == posted_.end()) return std::nullopt;
  Letter letter = std::move(*first);
  posted_.erase(first);
  return letter;
}

// Begins to send what was posted and looks what has been sent. Returns whether anything was. Letters are taken one by
// one: a duty on the way may call sendNow(), and those of one recipient stay in order.
bool Mailbox::sendPosted(Recipients recipients) {
  bool any = false;
  while (std::optional<Letter> letter = takePosted(recipients)) {
    any = true;
    guarded([&] {
      if (letter->other == rank_) {
        if (duties_.received) duties_.received(rank_, std::move(letter->bytes));
        return;
      }
      underWay_.push_back({letter->other, inBlocks(std::move(letter->bytes))});
      Letter& last = underWay_.back();
      // What cannot be sent has nobody to receive it.
      const int to = static_cast<int>(last.other);
      if (mpi_.send(to, last.bytes.data(), last.bytes.size() / kMpiBlock, &last.request) < 0) underWay_.pop_back();
    });
  }
  any |= std::erase_if(underWay_, [&](Letter& one) { return mpi_.over(&one.request) != 0; }) != 0;
  return any;
}

// Begins to receive what has begun to arrive, and delivers what is there. A message that finds no memory stays with MPI
// until the next look.
bool Mailbox::receiveAll() {
  bool any = false;
  int from = 0;
  uint64_t blocks = 0;
  while (mpi_.arrived(&from, &blocks) == 1) {
    bool begun = false;
    guarded([&] {
      arriving_.push_back({static_cast<uint32_t>(from), Bytes(blocks * kMpiBlock)});
      Letter& last = arriving_.back();
      begun = mpi_.receive(from, last.bytes.data(), blocks, &last.request) >= 0;
      if (!begun) arriving_.pop_back();
    });
    if (!begun) break;
    any = true;
    if (duties_.heard) guarded([&] { duties_.heard(static_cast<uint32_t>(from)); });
  }
  return deliverAll() || any;
}

// MPI has not ended and may still use the bytes of letters under way: they stay as long as the process.
void Mailbox::leaveToMpi() {
  static std::mutex mutex;
  static auto* const kept = new std::vector<std::deque<Letter>>;
  const std::lock_guard<std::mutex> lock(mutex);
  for (std::deque<Letter>* letters : {&underWay_, &arriving_}) {
    if (!letters->empty()) kept->push_back(std::move(*letters));
  }
}

// Delivers what has arrived. A large message may be overtaken by one of another process, but by none of its sender.
bool Mailbox::deliverAll() {
  bool any = false;
  for (size_t i = 0; i < arriving_.size();) {
    const auto letter = arriving_.begin() + static_cast<std::ptrdiff_t>(i);
    const bool first =
        std::none_of(arriving_.begin(), letter, [&](const Letter& earlier) { return earlier.other == letter->other; });
    const int over = first ? mpi_.over(&letter->request) : 0;
    if (over == 0) {
      ++i;
      continue;
    }
    any = true;
    Letter arrived = std::move(*letter);
    arriving_.erase(letter);
    // What cannot be received is lost with its sender.
    if (over > 0) guarded([&] { duties_.received(arrived.other, fromBlocks(std::move(arrived.bytes))); });
  }
  return any;
}

}  // namespace wavecrest

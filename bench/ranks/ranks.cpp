#include "bench/ranks/ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <new>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "engine/state/state_stream.h"

namespace wavecrest {
namespace {

using Clock = std::chrono::steady_clock;

// Snapshots that a process may be ahead of the slowest: each takes memory where it waits.
constexpr size_t kMostAhead = 2;
// Seconds between two heartbeats.
constexpr double kNews = 0.25;
// Seconds of silence after which a process is lost; fewer once all are to stop, as launchers do not wait long. Longest
// time that counts from one look to the next: a machine may have slept.
constexpr double kLostAfter = 60, kLostAfterStop = 10, kLongestLook = 0.1;

constexpr size_t kHead = 2 * sizeof(uint64_t);

double secondsBetween(Clock::time_point begin, Clock::time_point end) {
  return std::chrono::duration<double>(end - begin).count();
}

// Texts as bytes, each with its length.
std::vector<unsigned char> joined(const std::vector<std::string>& texts) {
  return savedBytes([&](StateWriter& out) {
    for (const std::string& text : texts) out.list(std::vector<char>(text.begin(), text.end()));
  });
}

std::vector<std::string> separated(std::span<const unsigned char> bytes) {
  StateReader in(bytes);
  std::vector<std::string> texts;
  while (in.left() != 0) {
    const auto text = in.list<char>();
    texts.emplace_back(text.begin(), text.end());
  }
  return texts;
}

}  // namespace

Ranks::Ranks(const Launch& launch) {
  const auto fail = [&](const std::string& wrong) {
    throw RanksError(
        fmt::format("{} has started {} processes, but {}; expected an MPI that both know (libopenmpi-dev when "
                    "wavecrest is built), or "
                    "{}=off, with which each process renders all by itself",
                    launch.by, launch.ranks, wrong, kMpiVariable));
  };
  try {
    mailbox_ = std::make_unique<Mailbox>(loadMpi());
  } catch (const RanksError& error) {
    fail(error.what());
  }
  if (count() != launch.ranks) fail(fmt::format("MPI connects {}", count()));
  tree_.emplace(rank(), count());
  silence_.resize(count());
  texts_.resize(count());
  paths_.resize(count());
  lastTick_ = lastNews_ = Clock::now();
  mailbox_->open({.received = [this](uint32_t from, Mailbox::Bytes message) { received(from, std::move(message)); },
                  .tick = [this] { tick(); },
                  .failed = [this](const std::exception& error) { failed(error); },
                  .heard = [this](uint32_t from) { silence_.at(from) = 0; }});
}

// Without finish the others are told to stop and to save: this process has failed. The mailbox' thread uses the
// members, so it ends before they go.
Ranks::~Ranks() {
  if (!mailbox_) return;
  watch({});
  sendToOthers(Kind::stop, 0);
  mailbox_->abandon();
}

void Ranks::send(uint32_t to, Kind kind, uint64_t number, std::span<const unsigned char> content) {
  Mailbox::Bytes message(kHead);
  message.insert(message.end(), content.begin(), content.end());
  sendWithHead(to, kind, number, std::move(message));
}

void Ranks::sendWithHead(uint32_t to, Kind kind, uint64_t number, Mailbox::Bytes message) {
  std::memcpy(message.data(), &kind, sizeof(kind));
  std::memcpy(message.data() + sizeof(kind), &number, sizeof(number));
  mailbox_->post(to, std::move(message));
}

void Ranks::sendToOthers(Kind kind, uint64_t number) {
  for (uint32_t to = 0; to < count(); ++to) {
    if (to != rank()) send(to, kind, number);
  }
}

void Ranks::wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& ready) {
  while (!ready()) {
    if (!broken_.empty()) throw RanksError(broken_);
    if (lost_) throw RanksError(fmt::format("process {} of {} is lost", *lost_ + 1, count()));
    if (stopping_ && hooks_.rescue) {
      const auto rescue = std::exchange(hooks_.rescue, nullptr);
      lock.unlock();
      rescue();
      lock.lock();
      continue;
    }
    changed_.wait_for(lock, std::chrono::milliseconds(50));
  }
}

std::vector<std::string> Ranks::exchange(const std::string& text) {
  send(0, Kind::text, 0, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
  std::unique_lock<std::mutex> lock(mutex_);
  wait(lock, [this] { return allTexts_.has_value(); });
  return *std::exchange(allTexts_, std::nullopt);
}

void Ranks::watch(RankHooks hooks) {
  const std::lock_guard<std::mutex> lock(mutex_);
  hooks_ = std::move(hooks);
  // What came before there was somebody to tell.
  if (stopping_ && hooks_.stop) hooks_.stop();
  if (hooks_.attend && (!wantedSaves_.empty() || !sums_.empty())) hooks_.attend();
}

void Ranks::contribute(SumLabel label, const Session& session, uint32_t threads) {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    if (isSnapshot(label)) {
      wait(lock, [this] { return outstanding_.size() < kMostAhead || stopping_; });
      outstanding_.push_back(label);
    }
    if (first()) own_[label] = session.statistics();
  }
  ProcessRecord record = recordOf(rank(), threads, session.statistics());
  record.contributions = contributions_;
  record.contributingSeconds = contributingSeconds_;
  record.addingSeconds = addingSeconds_.load();
  const Clock::time_point begin = Clock::now();
  sendWithHead(rank(), Kind::contribution, label, contributionOf(session, record, kHead));
  contributingSeconds_ += secondsBetween(begin, Clock::now());
  ++contributions_;
}

void Ranks::requestSave() { send(0, Kind::wantSave, 0); }

std::vector<SumLabel> Ranks::takeSaves() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(wantedSaves_, {});
}

std::optional<RankSum> Ranks::takeSum() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (sums_.empty()) return std::nullopt;
  RankSum sum = std::move(sums_.front());
  sums_.erase(sums_.begin());
  return sum;
}

RankSum Ranks::waitForSum() {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    wait(lock, [this] { return !sums_.empty(); });
  }
  return *takeSum();
}

uint64_t Ranks::pathsElsewhere() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::accumulate(paths_.begin(), paths_.end(), uint64_t{0});
}

void Ranks::finish() {
  watch({});
  mailbox_->finish();
}

void Ranks::received(uint32_t from, Mailbox::Bytes message) {
  if (message.size() < kHead || from >= count()) return;
  silence_[from] = 0;
  Kind kind{};
  uint64_t number = 0;
  std::memcpy(&kind, message.data(), sizeof(kind));
  std::memcpy(&number, message.data() + sizeof(kind), sizeof(number));
  const std::span<const unsigned char> content = std::span(message).subspan(kHead);
  std::unique_lock<std::mutex> lock(mutex_);
  switch (kind) {
    case Kind::text:
      takeText(from, {content.begin(), content.end()});
      break;
    case Kind::texts:
      allTexts_ = separated(content);
      break;
    case Kind::contribution: {
      const bool lastStands = !stopping_;
      lock.unlock();
      takeContribution(from, number, std::move(message), lastStands);
      return;
    }
    case Kind::completed:
      std::erase_if(outstanding_, [&](SumLabel label) { return label <= number; });
      break;
    case Kind::wantSave:
      // Requests that come while one is under way are the same: a launcher hands a signal to all processes.
      if (std::exchange(saveUnderWay_, true)) break;
      sendToOthers(Kind::save, saves_);
      wantedSaves_.push_back(saveLabel(saves_++));
      if (hooks_.attend) hooks_.attend();
      break;
    case Kind::save:
      wantedSaves_.push_back(saveLabel(number));
      if (hooks_.attend) hooks_.attend();
      break;
    case Kind::stop:
      callStop();
      break;
    case Kind::lost:
      lost_ = static_cast<uint32_t>(number);
      callStop();
      break;
    case Kind::paths:
      paths_[from] = number;
      break;
    case Kind::alive:
      break;
  }
  changed_.notify_all();
}

// With the mutex held.
void Ranks::callStop() {
  stopping_ = true;
  stopSaid_ = true;
  if (hooks_.stop) hooks_.stop();
}

void Ranks::takeText(uint32_t from, std::string text) {
  texts_[from] = std::move(text);
  if (!std::all_of(texts_.begin(), texts_.end(), [](const auto& one) { return one.has_value(); })) return;
  std::vector<std::string> all;
  for (auto& one : texts_) all.push_back(*std::exchange(one, std::nullopt));
  const std::vector<unsigned char> bytes = joined(all);
  for (uint32_t to = 1; to < count(); ++to) send(to, Kind::texts, 0, bytes);
  allTexts_ = std::move(all);
}

void Ranks::takeContribution(uint32_t from, SumLabel label, Mailbox::Bytes message, bool lastStands) {
  for (SumTree::Complete& sum : tree_->take(label, from, std::move(message), lastStands)) {
    complete(sum.label, std::move(sum.contributions));
  }
}

// Whoever waits for a sum or a message throws: it may be the one that was lost.
void Ranks::failed(const std::exception& error) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool film = dynamic_cast<const StateError*>(&error) != nullptr;
  const bool memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr ||
                      dynamic_cast<const std::length_error*>(&error) != nullptr;
  broken_ = film     ? fmt::format("films of processes do not add up: {}", error.what())
            : memory ? "out of memory for the sums of processes; expected a smaller film or fewer processes"
                     : error.what();
  changed_.notify_all();
}

void Ranks::complete(SumLabel label, std::vector<Mailbox::Bytes> messages) {
  // A process without children has nothing to add.
  if (!first() && messages.size() == 1) {
    mailbox_->post(tree_->parent(), std::move(messages.front()));
    return;
  }
  const Clock::time_point begin = Clock::now();
  std::vector<FilmSum::Bytes> contributions;
  contributions.reserve(messages.size());
  for (const Mailbox::Bytes& message : messages) contributions.push_back(FilmSum::Bytes(message).subspan(kHead));
  // Large films take long to add, and nobody is to think that this process is lost.
  sum_.sumUp(contributions, [this] {
    sendNews();
    mailbox_->sendNow();
  });
  if (!first()) {
    sendWithHead(tree_->parent(), Kind::contribution, label, sum_.contribution(kHead));
    addingSeconds_ += secondsBetween(begin, Clock::now());
    return;
  }
  // The sum of all.
  nlohmann::ordered_json processes = nlohmann::ordered_json::array();
  for (const ProcessRecord& process : sum_.processes()) processes.push_back(process.toJson());
  std::vector<float> image = sum_.film().resolve();
  addingSeconds_ += secondsBetween(begin, Clock::now());
  if (isSnapshot(label)) sendToOthers(Kind::completed, label);
  if (isSave(label)) saveUnderWay_ = false;
  const std::lock_guard<std::mutex> lock(mutex_);
  // Once this process is done, its last contribution may have stood for the others.
  const RenderStatistics& own = own_.at(own_.contains(label) ? label : kFinalLabel);
  sums_.push_back({label, sum_.statistics(own), std::move(image), std::move(processes)});
  // Snapshots that a save overtakes are still to come.
  std::erase_if(own_, [&](const auto& one) { return one.first == label || (isSnapshot(label) && one.first < label); });
  if (isSnapshot(label)) std::erase_if(outstanding_, [&](SumLabel one) { return one <= label; });
  if (hooks_.attend) hooks_.attend();
  changed_.notify_all();
}

// A heartbeat, where one is due: of the first process to all others, and theirs to it, with the paths so far.
void Ranks::sendNews() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (secondsBetween(lastNews_, now) < kNews) return;
  lastNews_ = now;
  if (first()) return sendToOthers(Kind::alive, 0);
  if (hooks_.paths) paths_[rank()] = hooks_.paths();
  send(0, Kind::paths, paths_[rank()]);
}

// Sends heartbeats, passes on signals that this process got, and finds processes that have been silent for too long.
void Ranks::tick() {
  sendNews();
  const Clock::time_point now = Clock::now();
  const double passed = std::min(secondsBetween(lastTick_, now), kLongestLook);
  lastTick_ = now;
  std::unique_lock<std::mutex> lock(mutex_);
  if (!stopSaid_ && hooks_.interrupted && hooks_.interrupted()) {
    stopSaid_ = stopping_ = true;
    sendToOthers(Kind::stop, 0);
  }
  if (hooks_.saveWanted && hooks_.saveWanted()) send(0, Kind::wantSave, 0);
  const double limit = stopping_ ? kLostAfterStop : kLostAfter;
  for (uint32_t other = 0; other < (first() ? count() : 1) && !lost_; ++other) {
    if (other == rank() || (silence_[other] += passed) < limit) continue;
    lost_ = other;
    sendToOthers(Kind::lost, other);
    callStop();
    changed_.notify_all();
  }
}

}  // namespace wavecrest

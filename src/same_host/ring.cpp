#include "ring.hpp"

#include <sched.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "doorbell.hpp"

namespace skein::same_host {
namespace {

constexpr std::size_t kHeader = 8;
// Flags of a frame: the first and the last of its message.
constexpr std::uint32_t kFirst = 1;
constexpr std::uint32_t kLast = 2;
// Not of a message: nothing comes before the ring's end.
constexpr std::uint32_t kSkip = 4;
// Of the last one of a message: it lends.
constexpr std::uint32_t kLends = 8;
// A longer message is published in parts, so that the reader copies while the writer does.
constexpr std::size_t kLargestFrame = 32 << 10;
// Where there is less room, the reader is waited for: a message is not cut into crumbs.
constexpr std::size_t kWorthwhile = 1 << 10;
// From here on an empty ring is used from its beginning again: one whose messages are small touches
// few pages.
constexpr std::size_t kRestart = 16 << 10;

// After so long without room the reader is called also where a caller is to read.
constexpr std::chrono::milliseconds kCallerLate{20};

constexpr std::uint64_t frame_size(std::uint64_t content) {
  return kHeader + ((content + kHeader - 1) & ~std::uint64_t{kHeader - 1});
}

std::atomic_ref<std::uint64_t> header_at(std::byte* place) {
  return std::atomic_ref(*reinterpret_cast<std::uint64_t*>(place));
}

std::uint64_t make_header(std::uint32_t kind, std::size_t size) {
  return std::uint64_t{kind} << 32 | size;
}

void check_distance(std::uint64_t distance, std::size_t capacity, const char* whose) {
  if (distance <= capacity && distance % kHeader == 0) return;
  throw BrokenRing(std::string("the ") + whose + " position is " +
                   std::to_string(static_cast<std::int64_t>(distance)) +
                   " octets from this side's, in a ring of " + std::to_string(capacity));
}

// From 1 on; 0 where the system does not tell.
std::uint32_t this_core() { return static_cast<std::uint32_t>(sched_getcpu() + 1); }

// Where a thread sleeps that can wait for its turn: one that had a real-time policy when it slept
// for the first time is woken at once.
std::uint32_t sleeping_core() {
  thread_local const int policy = sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
  const bool can_wait = policy == SCHED_OTHER || policy == SCHED_BATCH || policy == SCHED_IDLE;
  return can_wait ? this_core() : 0;
}

}  // namespace

// ---- writing

std::uint64_t RingWriter::in_flight() {
  const std::uint64_t read = place_.state->read.load();
  check_distance(written_ - read, place_.capacity, "reader's");
  read_ = read;
  return written_ - read;
}

bool RingWriter::may_restart(std::size_t offset, std::size_t size) {
  if (offset < kRestart) look_at_ = kRestart;
  if (offset < look_at_ || size > offset) return false;
  look_at_ = offset + kRestart / 4;  // not each time: the reader writes that line
  return in_flight() == 0;
}

void RingWriter::put_frame(std::uint32_t kind, std::span<const std::byte> content) {
  std::byte* const at = place_.content + written_ % place_.capacity;
  if (!content.empty()) std::memcpy(at + kHeader, content.data(), content.size());
  header_at(at).store(make_header(kind, content.size()), std::memory_order_relaxed);
  written_ += frame_size(content.size());
}

bool RingWriter::put(Part& part) {
  while (true) {
    std::size_t offset = written_ % place_.capacity;
    if (!part.begun && may_restart(offset, frame_size(part.rest.size()))) {
      header_at(place_.content + offset).store(make_header(kSkip, 0), std::memory_order_relaxed);
      written_ += place_.capacity - offset;
      offset = 0;
    }
    const std::size_t to_end = place_.capacity - offset;
    const std::size_t wanted =
        std::min({frame_size(part.rest.size()), frame_size(kLargestFrame), std::uint64_t{to_end}});
    const std::size_t enough = std::min(wanted, kWorthwhile);
    if (place_.capacity - (written_ - read_) < enough) in_flight();
    const std::size_t room = std::min(wanted, place_.capacity - (written_ - read_));
    if (room < enough) {
      publish(More::No);
      return false;
    }
    if (to_end == kHeader) {
      put_frame(kSkip, {});
      continue;
    }
    const auto content = part.rest.first(std::min(part.rest.size(), room - kHeader));
    part.rest = part.rest.subspan(content.size());
    const bool last = part.rest.empty();
    const std::uint32_t end = last ? kLast | (part.lends ? kLends : 0) : 0;
    put_frame((part.begun ? 0 : kFirst) | end, content);
    part.begun = true;
    if (last) {
      publish(part.lets_sleep ? More::Follows : More::No);
      return true;
    }
    if (content.size() == kLargestFrame) publish(More::Follows);
  }
}

// Sequentially consistent with what the reader does before it sleeps: either it sees this, or this
// sees it. Who sleeps on this core would only get its turn in place of this thread: it is woken
// once, at the end, or where there is no room.
void RingWriter::publish(More more) {
  RingState& state = *place_.state;
  state.written.store(written_);
  const std::uint32_t here = more == More::Follows ? this_core() : 0;
  if ((here == 0 || state.reader_core != here) && ring_reader()) ++wakes_;
  if ((here == 0 || state.caller_core != here) && wake(state.caller_sleeps)) ++wakes_;
}

// In one order with RingReader::take_back(): either it sees what was written, or this sees that it
// was taken back.
bool RingWriter::reader_sleeps() const {
  return place_.state->reader_sleeps.load() != 0 && place_.state->caller_reads.load() == 0;
}

bool RingWriter::ring_reader() {
  if (!reader_sleeps() || !is_to_be_woken(place_.state->reader_sleeps)) return false;
  ring(doorbell_);
  return true;
}

bool RingWriter::reader_sleeps_here() const {
  const RingState& state = *place_.state;
  const bool reader = reader_sleeps();
  const bool caller = state.caller_sleeps != 0;
  if (!reader && !caller) return false;
  const std::uint32_t here = this_core();
  return here != 0 &&
         ((reader && state.reader_core == here) || (caller && state.caller_core == here));
}

void RingWriter::wake_reader(Wakes& wakes) {
  ring_reader();
  if (is_to_be_woken(place_.state->caller_sleeps)) wakes.add(place_.state->caller_sleeps);
}

bool RingWriter::is_to_be_woken(Word& sleeps) {
  return sleeps.load() != 0 && sleeps.exchange(0) != 0;
}

bool RingWriter::wake(Word& sleeps) {
  const bool yes = is_to_be_woken(sleeps);
  if (yes) futex_wake(sleeps);
  return yes;
}

bool RingWriter::prepare_to_sleep() {
  place_.state->writer_sleeps.store(1);
  const std::uint64_t before = read_;
  if (in_flight() != 0 && read_ == before) return true;
  stay_awake();
  return false;
}

// False at the end; the reader may have taken something otherwise. The end is looked at first: a
// reader that always takes something must not put it off.
bool RingWriter::await_change(Instant deadline, const std::function<bool()>& ended) {
  if (std::chrono::steady_clock::now() >= deadline) return false;
  if (!prepare_to_sleep()) return !ended();
  const bool over = ended();
  if (!over) futex_wait(place_.state->writer_sleeps, 1, deadline);
  stay_awake();
  return !over;
}

// A caller that is to take what comes may do something else for now: then the reader does.
bool RingWriter::write(Part part, Duration patience, const std::function<bool()>& ended) {
  if (put(part)) return true;
  const Instant begin = std::chrono::steady_clock::now();
  const Instant deadline = begin + patience;
  Instant look = std::min(deadline, begin + kCallerLate);
  do {
    if (await_change(look, ended)) continue;
    if (ended() || look == deadline) return false;
    look = deadline;
    place_.state->caller_reads.store(0);
    ring_reader();
  } while (!put(part));
  return true;
}

bool RingWriter::await_empty(Instant deadline, const std::function<bool()>& ended) {
  while (in_flight() != 0) {
    if (!await_change(deadline, ended)) return false;
  }
  return true;
}

// ---- reading

std::uint64_t RingReader::available() {
  const std::uint64_t read = read_.load(std::memory_order_relaxed);
  std::uint64_t written = written_.load(std::memory_order_relaxed);
  if (written == read) {
    written = place_.state->written.load(std::memory_order_acquire);
    check_distance(written - read, place_.capacity, "writer's");
    written_.store(written, std::memory_order_relaxed);
  }
  return written - read;
}

bool RingReader::take(Bytes& message) {
  // No more at a time than the ring holds: a writer that never ends must not keep this thread.
  for (std::uint64_t taken = 0; taken < place_.capacity;) {
    const std::uint64_t waiting = available();
    if (waiting == 0) return false;
    const std::size_t offset = read_ % place_.capacity;
    const std::uint64_t to_end = place_.capacity - offset;
    std::byte* const at = place_.content + offset;
    const std::uint64_t header = header_at(at).load(std::memory_order_relaxed);
    const std::uint64_t size = header & 0xFFFF'FFFF;
    const auto kind = static_cast<std::uint32_t>(header >> 32);
    const std::uint64_t frame = kind == kSkip ? to_end : frame_size(size);
    const bool of_message =
        (kind & ~(kFirst | kLast | kLends)) == 0 && ((kind & kLends) == 0 || (kind & kLast) != 0);
    if (!of_message && (kind != kSkip || size != 0)) {
      throw BrokenRing("a frame of an unknown kind, " + std::to_string(kind));
    }
    if (frame > waiting || frame > to_end) {
      throw BrokenRing("a frame of " + std::to_string(frame) + " octets, of which " +
                       std::to_string(std::min(waiting, to_end)) + " can be there");
    }
    if (kind != kSkip) {
      if ((kind & kFirst) != 0) {
        message.clear();
      } else if (!begun_) {
        throw BrokenRing("a message that goes on without having begun");
      }
      begun_ = (kind & kLast) == 0;
      if (size > largest_ - message.size()) {
        throw BrokenRing("a message of more than " + std::to_string(largest_) + " octets");
      }
      message.append({at + kHeader, static_cast<std::size_t>(size)});
    }
    release(frame);
    taken += frame;
    lends_ = (kind & kLends) != 0;
    if ((kind & kLast) != 0) return true;
  }
  return false;
}

void RingReader::release(std::uint64_t size) {
  const std::uint64_t read = read_ + size;
  read_.store(read, std::memory_order_relaxed);
  place_.state->read.store(read);
  Word& sleeps = place_.state->writer_sleeps;
  if (sleeps.load() != 0 && sleeps.exchange(0) != 0) futex_wake(sleeps);
}

bool RingReader::prepare_to_sleep(Who who) {
  Word& core = who == Who::Reader ? place_.state->reader_core : place_.state->caller_core;
  const std::uint32_t here = sleeping_core();
  if (core.load(std::memory_order_relaxed) != here) core.store(here, std::memory_order_relaxed);
  word(who).store(1);
  if (place_.state->written.load() == read_ || (who == Who::Reader && lent())) return true;
  stay_awake(who);
  return false;
}

}  // namespace skein::same_host

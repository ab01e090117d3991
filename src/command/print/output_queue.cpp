#include "output_queue.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <condition_variable>
#include <csignal>
#include <cstring>
#include <list>
#include <mutex>
#include <utility>

#include "mission/process/wake_up.hpp"

namespace skein::command {
namespace {

constexpr std::chrono::seconds kToNotice{1};

struct Sink {
  int descriptor;
  std::size_t waiting = 0;   // bytes
  std::size_t left_out = 0;  // lines since the last one that had room
};

struct Piece {
  Sink* sink;
  std::string text;  // of whole lines, at first
};

/// A thread without signals: they are for others.
template <class Run>
std::thread quiet_thread(Run run) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread thread(std::move(run));
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace

struct OutputQueue::State {
  const std::size_t room;
  launch::StopRequest wake_up;
  std::mutex mutex;
  std::condition_variable changed;
  std::array<Sink, 2> sinks{Sink{STDOUT_FILENO}, Sink{STDERR_FILENO}};
  std::list<Piece> pieces;  // in the order in which they were added
  std::string loss;         // why something was not written, at first
  bool over = false;
  bool ended = false;  // the thread has

  explicit State(std::size_t size) : room(size) {}

  // These are called with the mutex locked.

  bool takes_more(const Sink& sink, std::size_t size) const {
    // Once it was full, it is so until there is room for more than the next line.
    return sink.left_out > 0 ? sink.waiting <= room / 2 : sink.waiting + size <= room;
  }

  void append(Sink& sink, const std::string& line) {
    // What belongs together is written at once, as far as a pipe takes it whole.
    if (pieces.empty() || pieces.back().sink != &sink || pieces.back().text.size() >= PIPE_BUF)
      pieces.push_back({&sink, ""});
    pieces.back().text.append(line) += '\n';
    if (sink.waiting == 0) wake_up.raise();
    sink.waiting += line.size() + 1;
  }

  void tell_left_out(Sink& sink) {
    if (sink.left_out == 0) return;
    const std::string count = std::to_string(std::exchange(sink.left_out, 0));
    append(sink, "* mission: left out here as nobody read them: " + count + " lines");
    lose("nobody read it");
  }

  void lose(const std::string& why) {
    if (loss.empty()) loss = why;
  }

  /// In the thread of the queue.
  void run() {
    for (;;) {
      std::array<pollfd, 3> watched{{{wake_up.descriptor(), POLLIN, 0}, {}, {}}};
      {
        const std::lock_guard lock(mutex);
        if (over) {
          ended = true;
          return changed.notify_all();
        }
        for (std::size_t i = 0; i < sinks.size(); ++i)
          watched[i + 1] = {sinks[i].waiting > 0 ? sinks[i].descriptor : -1, POLLOUT, 0};
      }
      ::poll(watched.data(), watched.size(), -1);
      wake_up.take();
      write_oldest({watched[1].revents != 0, watched[2].revents != 0});
    }
  }

  /// Of what those can take that are ready.
  void write_oldest(const std::array<bool, 2>& ready) {
    std::unique_lock lock(mutex);
    const auto piece = std::ranges::find_if(
        pieces, [&](const Piece& one) { return ready[one.sink == &sinks[1] ? 1 : 0]; });
    if (piece == pieces.end()) return;
    Sink& sink = *piece->sink;
    // A pipe that is ready takes so much without a wait.
    const std::string part = piece->text.substr(0, PIPE_BUF);
    lock.unlock();
    const auto size = ::write(sink.descriptor, part.data(), part.size());
    const int reason = errno;
    lock.lock();
    if (size < 0 && (reason == EINTR || reason == EAGAIN)) return;
    if (size < 0) lose(std::strerror(reason));
    const std::size_t done = size < 0 ? part.size() : static_cast<std::size_t>(size);
    sink.waiting -= done;
    piece->text.erase(0, done);
    if (piece->text.empty()) pieces.erase(piece);
    changed.notify_all();
  }
};

OutputQueue::OutputQueue(std::size_t room, std::chrono::milliseconds patience)
    : state_(std::make_shared<State>(room)),
      patience_(patience),
      thread_(quiet_thread([state = state_] { state->run(); })) {}

OutputQueue::~OutputQueue() {
  flush();
  std::unique_lock lock(state_->mutex);
  state_->over = true;
  state_->wake_up.raise();
  const bool ended = state_->changed.wait_for(lock, kToNotice, [&] { return state_->ended; });
  lock.unlock();
  if (ended) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

void OutputQueue::add(int descriptor, const std::string& line) {
  const std::lock_guard lock(state_->mutex);
  Sink& sink = state_->sinks[descriptor == STDOUT_FILENO ? 0 : 1];
  if (!state_->takes_more(sink, line.size() + 1)) {
    ++sink.left_out;
    return;
  }
  state_->tell_left_out(sink);
  state_->append(sink, line);
}

std::string OutputQueue::flush() {
  std::unique_lock lock(state_->mutex);
  for (Sink& sink : state_->sinks) state_->tell_left_out(sink);
  if (!last_moment_) last_moment_ = std::chrono::steady_clock::now() + patience_;
  const bool all =
      state_->changed.wait_until(lock, *last_moment_, [&] { return state_->pieces.empty(); });
  if (!all) state_->lose("nobody reads it");
  return state_->loss;
}

}  // namespace skein::command

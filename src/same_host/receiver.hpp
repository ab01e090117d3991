#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "call_port/call_port.hpp"
#include "lead.hpp"
#include "led_links.hpp"
#include "received_link.hpp"
#include "skein/clock.hpp"

namespace skein::same_host {

/// One thread that takes messages from many links, and sleeps while none has any; links that bring
/// nothing cost it nothing. A thread that waits for a message of one link may take it itself; one
/// that waits for any link's may lead in the receiver's place. If that one leaves its turn, and
/// does not come back within 10 ms, the receiver's own thread takes what comes until it does. A
/// link that brings more of a message without its end than others leave room for is ended.
/// Thread-safe.
class Receiver {
 public:
  /// `name` is the thread's, which starts with the first link; `spin` as SpinPolicy's limit.
  Receiver(std::string name, TimeSpan spin,
           std::shared_ptr<Unfinished> unfinished = std::make_shared<Unfinished>());
  /// No function of an inbox runs any more, but for those that have left the turn of a thread that
  /// led in the receiver's place.
  ~Receiver();
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  /// For Link: makes the thread look whether links have ended. It may outlive the receiver.
  std::function<void()> notifier() const;

  /// Throws Unavailable where there is no thread. What it returns is for threads that wait for what
  /// this link brings.
  std::shared_ptr<calls::CallerDelivery> add(std::shared_ptr<Link> link, Inbox& inbox);
  /// For one thread that takes what all links bring. Between its calls of deliver_until() it is as
  /// one that has left its turn: take_back() says that it does not come back soon. For inboxes that
  /// leave their turn on no other thread.
  std::shared_ptr<calls::CallerDelivery> delivery() const;
  /// None of its functions runs, or will run, but for those whose turn was left: these may outlive
  /// the inbox, and must not use it any more. Not from one of them.
  void remove(Inbox& inbox);
  std::size_t links() const;

 private:
  class Consumer;

  void run();
  bool lead(Taker::Who who, const std::function<bool()>& over);
  void take_in_changes();

  const std::string name_;
  const Duration spin_limit_;
  const std::shared_ptr<Unfinished> unfinished_;
  const std::shared_ptr<ReceiverNews> news_;
  mutable std::mutex mutex_;
  LedLinks::Links links_;
  LedLinks::Links added_;  // since the leading thread last looked
  std::uint64_t last_id_ = 0;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
  const std::shared_ptr<Lead> lead_ = std::make_shared<Lead>();
  const std::shared_ptr<Consumer> consumer_;
  // The leading thread's. A consumer that has left its turn keeps no link from ending.
  LedLinks led_;
};

}  // namespace skein::same_host

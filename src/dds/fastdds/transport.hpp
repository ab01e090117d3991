#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>

#include "acknack_repair.hpp"
#include "announcement_pace.hpp"
#include "dds/rtps/rtps_guard.hpp"
#include "fast_dds.hpp"
#include "fast_lease_watch.hpp"
#include "forgetting.hpp"
#include "suspend_detector.hpp"

namespace skein::dds::fastdds {

/// Where Fast DDS hears of participants, so that it can be told that one has gone. It receives one
/// message of discovery at a time, on however many interfaces: the proxies of participants are not
/// made for more, and a farewell must not be overtaken (forgetting.hpp). Not to be called with a
/// lock that a listener takes.
class DiscoveryInput {
 public:
  using Receiver = transports::TransportReceiverInterface;

  /// Lockable; to be held while an endpoint is removed: no message of discovery is received then
  /// (liveliness.hpp).
  class Removal {
   public:
    explicit Removal(std::mutex& input) : input_(input) {}
    void lock() {
      ++wanted_;
      input_.lock();
    }
    bool try_lock() {
      if (!input_.try_lock()) return false;
      ++wanted_;
      return true;
    }
    void unlock() {
      --wanted_;
      input_.unlock();
    }
    /// Whether somebody has it, or waits for it: others are not heard meanwhile.
    bool is_wanted() const noexcept { return wanted_ > 0; }

   private:
    std::mutex& input_;
    std::atomic<int> wanted_{0};
  };
  Removal& removal() noexcept { return removal_; }

  /// An announcement comes in here.
  void announced_at(Receiver* receiver) { receiver_ = receiver; }

  /// Lets Fast DDS receive what the guard passed of a message of discovery.
  void receive(Receiver& receiver, unsigned char* message, const RtpsGuard::Passed& passed,
               const rtps::Locator_t& local, const rtps::Locator_t& remote);

  /// Lets Fast DDS receive a participant's farewell.
  void say_farewell(const Guid& participant);

  /// Waits for a farewell that is being received; none is received afterwards.
  void close();

  /// What this participant has announced of its endpoints.
  SentAnnouncements sent;

 private:
  void acknowledge_all(Receiver& receiver, const Guid& participant);

  std::atomic<Receiver*> receiver_{nullptr};
  std::mutex mutex_;
  Removal removal_{mutex_};
  bool closed_ = false;  // under mutex_
};

/// A transport before Fast DDS's UDP that guards its parser, repairs what is received, notes who is
/// heard of, puts off leases, keeps silence after a sleep, leaves out announcements that nobody
/// needs, and sends nothing until the participant has been made: Fast DDS announces itself before
/// it listens, and nobody repeats the answers.
struct StartupTransportDescriptor : transports::ChainingTransportDescriptor {
  StartupTransportDescriptor(std::shared_ptr<transports::TransportDescriptorInterface> udp,
                             std::chrono::nanoseconds lease,
                             std::chrono::nanoseconds announcement_period, Addresses addresses)
      : ChainingTransportDescriptor(std::move(udp)),
        state(std::make_shared<State>(lease, announcement_period, std::move(addresses))) {}

  transports::TransportInterface* create_transport() const override;

  /// Also what Fast DDS takes for filled between two heartbeats, and it counts a sample's fragments
  /// again and again: at 4 MiB the twelfth and the seventeenth of a mebibyte carry one, and the
  /// reader asks for what is on its way to him.
  static constexpr std::uint32_t kSendBuffer = 64u << 20;
  std::uint32_t min_send_buffer_size() const override { return kSendBuffer; }

  struct State {
    State(std::chrono::nanoseconds lease, std::chrono::nanoseconds announcement_period,
          Addresses addresses)
        : suspend(lease),
          pace(announcement_period),
          guard(std::move(addresses), "dds/fastdds", SkippedNumbers::Counted) {}
    std::atomic<bool> open{false};        // lets messages out
    std::atomic<std::uint32_t> ports{0};  // on which it listens
    FastLeaseWatch lease_watch;
    SuspendDetector suspend;
    AnnouncementPace pace;
    RtpsGuard guard;
    DiscoveryInput discovery;
  };
  std::shared_ptr<State> state;
};

}  // namespace skein::dds::fastdds

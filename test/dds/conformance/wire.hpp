#pragma once

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "dds/port/port.hpp"
#include "skein/error.hpp"
#include "test/tools/eventually.hpp"

namespace skein::dds::conformance {

/// Which vendor writes and which reads. Each program of the suite defines its own
/// (conformance_pairing.cpp).
struct Pairing {
  std::string writing;
  std::string reading;
};
extern const Pairing kPairing;

/// A domain that no other test of this program uses.
std::uint32_t fresh_domain();

/// One participant of the writing and one of the reading vendor, on a domain of their own.
struct Wire {
  Wire();
  std::uint32_t domain;
  std::unique_ptr<Participant> writing;
  std::unique_ptr<Participant> reading;
};

std::unique_ptr<Participant> make_participant(
    const std::string& vendor, std::uint32_t domain,
    std::chrono::milliseconds lease = std::chrono::seconds(10));

struct Received {
  std::vector<std::byte> cdr;
  InstanceState state;
  KeyHash key;
  Guid writer;
};

/// A reader that keeps what it is told.
class Inbox {
 public:
  Inbox(Participant& participant, const Topic& topic, const Qos& qos);

  Reader& reader() { return *reader_; }
  void close() { reader_.reset(); }
  std::vector<Received> received() const;
  std::size_t count() const;
  void forget_samples();
  std::vector<std::pair<Guid, bool>> matches() const;
  std::vector<std::pair<Guid, bool>> liveliness() const;
  std::vector<KeyHash> missed_deadlines() const;
  std::vector<Incompatibility> incompatible() const;

 private:
  mutable std::mutex mutex_;
  std::vector<KeyHash> missed_deadlines_;
  std::vector<Incompatibility> incompatible_;
  std::vector<Received> received_;
  std::vector<std::pair<Guid, bool>> matches_;
  std::vector<std::pair<Guid, bool>> liveliness_;
  std::unique_ptr<Reader> reader_;
};

/// A writer that keeps what it is told.
class Outbox {
 public:
  Outbox(Participant& participant, const Topic& topic, const Qos& qos);

  Writer& writer() { return *writer_; }
  void close() { writer_.reset(); }
  std::vector<std::pair<Guid, bool>> matches() const;
  std::vector<KeyHash> missed_deadlines() const;
  std::vector<Incompatibility> incompatible() const;

 private:
  mutable std::mutex mutex_;
  std::vector<KeyHash> missed_deadlines_;
  std::vector<Incompatibility> incompatible_;
  std::vector<std::pair<Guid, bool>> matches_;
  std::unique_ptr<Writer> writer_;
};

/// Waits until both sides know of each other. That proves little for a volatile reader: Cyclone DDS
/// ignores a matched Fast DDS writer until its first heartbeat.
bool matched(Outbox& outbox, Inbox& inbox);

/// Waits until samples of a keyless, reliable writer arrive; forgets those that tried it.
bool connected(Outbox& outbox, Inbox& inbox);

/// A sample of `size` bytes with its header; its content depends on `seed`.
std::vector<std::byte> make_sample(std::size_t size, std::uint32_t seed = 0);

/// A sample whose body is one number, and the number in it.
std::vector<std::byte> make_number(std::uint32_t value);
std::uint32_t to_number(const std::vector<std::byte>& cdr);
std::vector<std::uint32_t> numbers(const std::vector<Received>& received);

KeyHash make_key(std::uint8_t number);

Topic keyless(const std::string& name = "conformance");
Topic keyed(const std::string& name = "conformance_keyed");

/// Everything, reliably, to those who are there.
Qos keep_all();
/// The last sample of each instance, for those who come late too.
Qos last_state();

}  // namespace skein::dds::conformance

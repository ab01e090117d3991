#include "wire.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <random>

namespace skein::dds::conformance {
namespace {

constexpr std::byte kLittleEndianCdr[4] = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};

}  // namespace

std::uint32_t fresh_domain() {
  static std::atomic<std::uint32_t> last{0};
  return last++ % 233;
}

std::unique_ptr<Participant> make_participant(const std::string& vendor, std::uint32_t domain,
                                              std::chrono::milliseconds lease) {
  ParticipantOptions options;
  options.domain = domain;
  options.name = "conformance";
  options.lease = lease;
  options.network.max_participants = 12;
  return load_vendor(vendor)->create_participant(options);
}

Wire::Wire()
    : domain(fresh_domain()),
      writing(make_participant(kPairing.writing, domain)),
      reading(make_participant(kPairing.reading, domain)) {}

Inbox::Inbox(Participant& participant, const Topic& topic, const Qos& qos) {
  ReaderListener listener;
  listener.on_data = [this](Reader& reader) {
    reader.take([this](const Sample& sample) {
      std::lock_guard lock(mutex_);
      received_.push_back(
          {{sample.cdr.begin(), sample.cdr.end()}, sample.state, sample.key, sample.writer});
    });
  };
  listener.on_matched = [this](const Guid& writer, bool matched) {
    std::lock_guard lock(mutex_);
    matches_.emplace_back(writer, matched);
  };
  listener.on_liveliness = [this](const Guid& writer, bool alive) {
    std::lock_guard lock(mutex_);
    liveliness_.emplace_back(writer, alive);
  };
  listener.on_deadline_missed = [this](const KeyHash& key) {
    std::lock_guard lock(mutex_);
    missed_deadlines_.push_back(key);
  };
  listener.on_incompatible = [this](const Incompatibility& why) {
    std::lock_guard lock(mutex_);
    incompatible_.push_back(why);
  };
  reader_ = participant.create_reader(topic, qos, std::move(listener));
}

std::vector<Received> Inbox::received() const {
  std::lock_guard lock(mutex_);
  return received_;
}

std::size_t Inbox::count() const {
  std::lock_guard lock(mutex_);
  return received_.size();
}

void Inbox::forget_samples() {
  std::lock_guard lock(mutex_);
  received_.clear();
}

std::vector<std::pair<Guid, bool>> Inbox::matches() const {
  std::lock_guard lock(mutex_);
  return matches_;
}

std::vector<std::pair<Guid, bool>> Inbox::liveliness() const {
  std::lock_guard lock(mutex_);
  return liveliness_;
}

std::vector<KeyHash> Inbox::missed_deadlines() const {
  std::lock_guard lock(mutex_);
  return missed_deadlines_;
}

std::vector<Incompatibility> Inbox::incompatible() const {
  std::lock_guard lock(mutex_);
  return incompatible_;
}

Outbox::Outbox(Participant& participant, const Topic& topic, const Qos& qos) {
  WriterListener listener;
  listener.on_matched = [this](const Guid& reader, bool matched) {
    std::lock_guard lock(mutex_);
    matches_.emplace_back(reader, matched);
  };
  listener.on_deadline_missed = [this](const KeyHash& key) {
    std::lock_guard lock(mutex_);
    missed_deadlines_.push_back(key);
  };
  listener.on_incompatible = [this](const Incompatibility& why) {
    std::lock_guard lock(mutex_);
    incompatible_.push_back(why);
  };
  writer_ = participant.create_writer(topic, qos, std::move(listener));
}

std::vector<std::pair<Guid, bool>> Outbox::matches() const {
  std::lock_guard lock(mutex_);
  return matches_;
}

std::vector<KeyHash> Outbox::missed_deadlines() const {
  std::lock_guard lock(mutex_);
  return missed_deadlines_;
}

std::vector<Incompatibility> Outbox::incompatible() const {
  std::lock_guard lock(mutex_);
  return incompatible_;
}

bool matched(Outbox& outbox, Inbox& inbox) {
  const auto contains = [](const std::vector<Guid>& guids, const Guid& guid) {
    return std::find(guids.begin(), guids.end(), guid) != guids.end();
  };
  return test::eventually([&] {
    return contains(outbox.writer().matched_readers(), inbox.reader().guid()) &&
           contains(inbox.reader().matched_writers(), outbox.writer().guid());
  });
}

bool connected(Outbox& outbox, Inbox& inbox) {
  if (!matched(outbox, inbox)) return false;
  std::uint32_t last = 0;
  const bool heard = test::eventually([&] {
    outbox.writer().write(make_number(++last));
    return inbox.count() > 0;
  });
  const bool all =
      heard && test::eventually([&] { return to_number(inbox.received().back().cdr) == last; });
  inbox.forget_samples();
  return all;
}

std::vector<std::byte> make_sample(std::size_t size, std::uint32_t seed) {
  std::vector<std::byte> sample(size);
  std::minstd_rand random(seed + static_cast<std::uint32_t>(size));
  for (std::byte& byte : sample) byte = static_cast<std::byte>(random());
  std::memcpy(sample.data(), kLittleEndianCdr, sizeof kLittleEndianCdr);
  return sample;
}

std::vector<std::byte> make_number(std::uint32_t value) {
  auto sample = make_sample(8);
  std::memcpy(sample.data() + 4, &value, sizeof value);
  return sample;
}

std::uint32_t to_number(const std::vector<std::byte>& cdr) {
  std::uint32_t value = 0;
  if (cdr.size() >= 8) std::memcpy(&value, cdr.data() + 4, sizeof value);
  return value;
}

std::vector<std::uint32_t> numbers(const std::vector<Received>& received) {
  std::vector<std::uint32_t> values;
  for (const Received& sample : received) values.push_back(to_number(sample.cdr));
  return values;
}

KeyHash make_key(std::uint8_t number) {
  KeyHash key;
  for (std::size_t i = 0; i < key.bytes.size(); ++i) {
    key.bytes[i] = static_cast<std::uint8_t>(number + 7 * i);
  }
  return key;
}

Topic keyless(const std::string& name) { return {name, "skein::test::Blob", false}; }

Topic keyed(const std::string& name) { return {name, "skein::test::KeyedBlob", true}; }

Qos keep_all() { return {}; }

Qos last_state() {
  Qos qos;
  qos.transient_local = true;
  qos.history_depth = 1;
  return qos;
}

}  // namespace skein::dds::conformance

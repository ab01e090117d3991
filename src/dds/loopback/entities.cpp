#include "entities.hpp"

#include "dds/port/options_check.hpp"
#include "dds/port/sample_format.hpp"
#include "dds/port/vendor_names.hpp"

namespace skein::dds::loopback {
namespace {

class LoopbackWriter final : public Writer {
 public:
  LoopbackWriter(std::shared_ptr<Hub> hub, std::shared_ptr<WriterCore> core)
      : hub_(std::move(hub)), core_(std::move(core)) {
    hub_->add(core_);
  }
  ~LoopbackWriter() override {
    hub_->remove(*core_);
    core_->participant->topics.release(core_->topic.name, [](int) {});
  }

  void write(std::span<const std::byte> cdr, const KeyHash& key) override {
    check_sample(cdr, core_->topic.name);
    hub_->write(*core_, cdr, core_->topic.keyed ? key : KeyHash{}, InstanceState::Alive);
  }
  void dispose(const KeyHash& key) override {
    require_keyed(core_->topic);
    hub_->write(*core_, {}, key, InstanceState::Disposed);
  }
  bool wait_for_acknowledgments(std::chrono::milliseconds timeout) override {
    return hub_->wait_for_acknowledgments(*core_, timeout);
  }
  Guid guid() const override { return core_->guid; }
  std::vector<Guid> matched_readers() const override { return hub_->matched(*core_); }

 private:
  std::shared_ptr<Hub> hub_;
  std::shared_ptr<WriterCore> core_;
};

class LoopbackReader final : public Reader {
 public:
  LoopbackReader(std::shared_ptr<Hub> hub, std::shared_ptr<ReaderCore> core)
      : hub_(std::move(hub)), core_(std::move(core)) {
    core_->self = this;
    hub_->add(core_);
  }
  ~LoopbackReader() override {
    hub_->remove(*core_);
    core_->participant->topics.release(core_->topic.name, [](int) {});
  }

  std::size_t take(const std::function<void(const Sample&)>& consumer, std::size_t limit) override {
    return core_->queue.take(consumer, limit);
  }
  Guid guid() const override { return core_->guid; }
  std::vector<Guid> matched_writers() const override { return hub_->matched(*core_); }
  ReceiveCounters counters() const override { return core_->queue.counters(); }

 private:
  std::shared_ptr<Hub> hub_;
  std::shared_ptr<ReaderCore> core_;
};

// RTPS entity kinds: with key, without key.
constexpr std::uint8_t kWriterKind = 0x02;
constexpr std::uint8_t kReaderKind = 0x07;

class LoopbackParticipant final : public Participant {
 public:
  LoopbackParticipant(std::shared_ptr<Hub> hub, const ParticipantOptions& options)
      : hub_(std::move(hub)), core_(hub_->join(options)) {}
  ~LoopbackParticipant() override { hub_->leave(core_); }

  std::unique_ptr<Writer> create_writer(const Topic& topic, const Qos& qos,
                                        WriterListener listener) override {
    check_qos(topic, qos);
    auto core = std::make_shared<WriterCore>(qos, *hub_);
    prepare(*core, topic, qos, kWriterKind);
    core->listener = std::move(listener);
    return std::make_unique<LoopbackWriter>(hub_, std::move(core));
  }
  std::unique_ptr<Reader> create_reader(const Topic& topic, const Qos& qos,
                                        ReaderListener listener) override {
    check_qos(topic, qos);
    auto core = std::make_shared<ReaderCore>(topic, qos, *hub_);
    prepare(*core, topic, qos, kReaderKind);
    core->listener = std::move(listener);
    return std::make_unique<LoopbackReader>(hub_, std::move(core));
  }
  Guid guid() const override { return core_->guid; }

 private:
  void prepare(EndpointCore& endpoint, const Topic& topic, const Qos& qos, std::uint8_t kind) {
    core_->topics.acquire(topic, [] { return 0; });
    endpoint.participant = core_;
    endpoint.topic = topic;
    endpoint.qos = qos;
    endpoint.guid = core_->guid;
    const std::uint32_t number = ++core_->last_entity;
    endpoint.guid.bytes[12] = static_cast<std::uint8_t>(number >> 16);
    endpoint.guid.bytes[13] = static_cast<std::uint8_t>(number >> 8);
    endpoint.guid.bytes[14] = static_cast<std::uint8_t>(number);
    endpoint.guid.bytes[15] = kind;
  }

  std::shared_ptr<Hub> hub_;
  std::shared_ptr<ParticipantCore> core_;
};

class LoopbackVendor final : public Vendor {
 public:
  explicit LoopbackVendor(std::shared_ptr<Hub> hub) : hub_(std::move(hub)) {}
  std::string name() const override { return kLoopback; }
  bool is_inside_process() const override { return true; }
  std::unique_ptr<Participant> create_participant(const ParticipantOptions& options) override {
    check_options(options);
    refuse_shared_memory(options, "the loopback network");
    return std::make_unique<LoopbackParticipant>(hub_, options);
  }

 private:
  std::shared_ptr<Hub> hub_;
};

}  // namespace

std::shared_ptr<Vendor> make_vendor(std::shared_ptr<Hub> hub) {
  return std::make_shared<LoopbackVendor>(std::move(hub));
}

}  // namespace skein::dds::loopback

#pragma once

#include "dds/port/vendor_names.hpp"
#include "hub.hpp"

namespace skein::dds::loopback {

class LoopbackVendor final : public Vendor {
 public:
  explicit LoopbackVendor(std::shared_ptr<Hub> hub) : hub_(std::move(hub)) {}
  std::string name() const override { return kLoopback; }
  bool is_inside_process() const override { return true; }
  std::unique_ptr<Participant> create_participant(const ParticipantOptions& options) override;

 private:
  std::shared_ptr<Hub> hub_;
};

class LoopbackParticipant final : public Participant {
 public:
  LoopbackParticipant(std::shared_ptr<Hub> hub, const ParticipantOptions& options)
      : hub_(std::move(hub)), core_(hub_->join(options)) {}
  ~LoopbackParticipant() override { hub_->leave(core_); }

  std::unique_ptr<Writer> create_writer(const Topic& topic, const Qos& qos,
                                        WriterListener listener) override;
  std::unique_ptr<Reader> create_reader(const Topic& topic, const Qos& qos,
                                        ReaderListener listener) override;
  Guid guid() const override { return core_->guid; }

 private:
  void prepare(EndpointCore& endpoint, const Topic& topic, const Qos& qos, std::uint8_t kind);

  std::shared_ptr<Hub> hub_;
  std::shared_ptr<ParticipantCore> core_;
  std::mutex mutex_;
};

}  // namespace skein::dds::loopback

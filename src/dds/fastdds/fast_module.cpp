#include "dds/port/module.hpp"
#include "fast_dds.hpp"
#include "fast_log.hpp"
#include "fast_participant.hpp"

namespace skein::dds::fastdds {
namespace {

class FastVendor final : public Vendor {
 public:
  FastVendor() {
    // At exit the static objects go in the opposite order, and what Fast DDS holds in such came
    // last. Entities in objects of that kind would end without it, so it stays.
    keep_static_objects();
    route_log();
    // It would call a reader's listener inside write(), past the transport and with both endpoints'
    // locks held. Participants of one process are to be as independent as others.
    turn_off_intraprocess_delivery();
  }
  std::string name() const override { return "fastdds"; }
  std::unique_ptr<Participant> create_participant(const ParticipantOptions& options) override {
    return std::make_unique<FastParticipant>(options);
  }
};

}  // namespace
}  // namespace skein::dds::fastdds

std::uint32_t skein_module_abi() { return SKEIN_ABI; }

std::shared_ptr<skein::dds::Vendor>* skein_module_vendor() {
  static auto* vendor =
      new std::shared_ptr<skein::dds::Vendor>(std::make_shared<skein::dds::fastdds::FastVendor>());
  return vendor;
}

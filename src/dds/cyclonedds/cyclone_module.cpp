#include "cyclone_log.hpp"
#include "cyclone_participant.hpp"
#include "dds/port/module.hpp"
#include "steady_waits.hpp"

namespace skein::dds::cyclonedds {
namespace {

class CycloneVendor final : public Vendor {
 public:
  CycloneVendor() {
    route_log();
    wait_by_steady_clock();
  }
  std::string name() const override { return "cyclonedds"; }
  std::unique_ptr<Participant> create_participant(const ParticipantOptions& options) override {
    return std::make_unique<CycloneParticipant>(options);
  }
};

}  // namespace
}  // namespace skein::dds::cyclonedds

std::uint32_t skein_module_abi() { return SKEIN_ABI; }

std::shared_ptr<skein::dds::Vendor>* skein_module_vendor() {
  static auto* vendor = new std::shared_ptr<skein::dds::Vendor>(
      std::make_shared<skein::dds::cyclonedds::CycloneVendor>());
  return vendor;
}

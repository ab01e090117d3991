#include "dds/module.hpp"

#include <fastrtps/xmlparser/XMLProfileManager.h>

#include "log.hpp"
#include "participant.hpp"

namespace skein::dds::fastdds {
namespace {

/// Within a process Fast DDS would call a reader's listener inside write(), past the transport and
/// with both endpoints' locks held. Participants of one process are to be as independent as others.
void deliver_by_transport_only() {
  eprosima::fastrtps::LibrarySettingsAttributes settings;
  settings.intraprocess_delivery = eprosima::fastrtps::INTRAPROCESS_OFF;
  eprosima::fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
}

class FastVendor final : public Vendor {
 public:
  FastVendor() {
    route_log();
    deliver_by_transport_only();
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

#include <fastrtps/xmlparser/XMLProfileManager.h>

#include "dds/port/module.hpp"
#include "fast_log.hpp"
#include "fast_participant.hpp"

// Fast DDS's own, exported but in no header.
namespace eprosima::fastrtps::rtps {
class RTPSDomainImpl {
 public:
  static std::shared_ptr<RTPSDomainImpl> get_instance();
};
}  // namespace eprosima::fastrtps::rtps
namespace eprosima::fastdds::dds::detail {
struct LogResources;
std::shared_ptr<LogResources> get_log_resources();
}  // namespace eprosima::fastdds::dds::detail

namespace skein::dds::fastdds {
namespace {

/// At exit the static objects go in the opposite order, and what Fast DDS holds in such came last.
/// Entities in objects of that kind would end without it, so it stays. `used`: a check for leaks
/// looks for these pointers, which nobody reads.
void outlive_static_objects() {
  [[gnu::used]] static const auto* const domain =
      new auto(eprosima::fastrtps::rtps::RTPSDomainImpl::get_instance());
  [[gnu::used]] static const auto* const log =
      new auto(eprosima::fastdds::dds::detail::get_log_resources());
}

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
    outlive_static_objects();
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

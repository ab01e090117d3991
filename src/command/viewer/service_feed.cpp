#include "service_feed.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "brokerless_discovery/broker.hpp"
#include "core/log.hpp"
#include "core/printable.hpp"
#include "core/system/interface_name.hpp"
#include "idl/types/flags.hpp"
#include "skein/discovery.idl.hpp"
#include "skein/dynamic.hpp"
#include "skein/entity.hpp"
#include "skein/inspector.hpp"

namespace skein::command {
namespace {

constexpr std::chrono::seconds kServiceWithin{2};
constexpr std::size_t kLongestExplanation = 1024;

/// One provider, connected to at the first call.
class Provider {
 public:
  Provider(Entity& entity, ConnectOptions options)
      : entity_(entity), options_(std::move(options)) {}

  void call(const std::string& operation, std::string_view request, const view::Answer& answer) {
    if (!proxy_) proxy_ = connect_dynamic(entity_, options_);
    proxy_->async_call(operation, std::string(request)).then([answer](Call<std::string> ended) {
      try {
        answer.respond(ended.get());
      } catch (const std::exception& error) {
        answer.fail(error.what());
      }
    });
  }

 private:
  Entity& entity_;
  const ConnectOptions options_;
  std::optional<DynamicProxy> proxy_;
};

/// Operations of the interface and its bases, but for streams.
std::set<std::string> operations_of(const types::TypeSystem& types, const std::string& interface) {
  std::set<std::string> names{interface};  // grows by bases
  std::set<std::string> operations;
  for (std::size_t known = 0; known != names.size();) {
    known = names.size();
    for (const types::Interface& each : types.interfaces) {
      if (!names.contains(each.name)) continue;
      names.insert(each.bases.begin(), each.bases.end());
      for (const types::Operation& operation : each.operations) {
        const bool streams = idl::has(operation.flags, types::OperationFlags::stream);
        if (!streams) operations.insert(operation.name);
      }
    }
  }
  return operations;
}

}  // namespace

void ServiceFeed::update() {
  const auto& broker = entity_.broker();
  std::erase_if(offered_, [&](const auto& each) {
    if (broker.knows(each.first)) return false;
    for (const view::ServiceId service : each.second) server_.remove_service(service);
    return true;
  });
  auto asked = broker.all();
  std::vector<Inspector::TypesWanted> wanted;
  std::erase_if(asked, [&](const auto& service) {
    const Guid provider{service->provider};
    if (!service->owner.empty()) return true;  // its entity's alone
    if (offered_.contains(provider) || late_.contains(provider)) return true;
    const auto participant = broker.participant_of(provider);
    if (participant) wanted.push_back({service->service, *participant});
    return !participant;  // it has just gone
  });
  inspector_.types(wanted, kServiceWithin, [&](std::size_t index, const types::TypeSystem& told) {
    offer(*asked[index], told);
  });
  late_.clear();
  for (const auto& service : asked)
    if (!offered_.contains(Guid{service->provider})) note_late(*service);
}

void ServiceFeed::note_late(const discovery::ServiceDescription& service) {
  late_.insert(Guid{service.provider});
  log(LogLevel::Warning, "view",
      printable(service.service + ": its provider did not tell its types", kLongestExplanation));
}

void ServiceFeed::offer(const discovery::ServiceDescription& service,
                        const types::TypeSystem& types) {
  const Guid provider{service.provider};
  try {
    offered_.emplace(provider, operations(service, types));
  } catch (const InvalidArgument& error) {  // what was told makes no sense
    offered_.emplace(provider, std::vector<view::ServiceId>());
    log(LogLevel::Warning, "view",
        printable(service.service + " is not offered: " + error.what(), kLongestExplanation));
  }
}

std::vector<view::ServiceId> ServiceFeed::operations(const discovery::ServiceDescription& service,
                                                     const types::TypeSystem& types) {
  ConnectOptions options;
  options.name = service.service;
  options.system = std::string(ConnectOptions::kAnySystem);
  options.provider = Guid{service.provider};
  options.timeout = kServiceWithin;
  const auto provider = std::make_shared<Provider>(entity_, std::move(options));
  const std::string interface = scoped_interface_name(service.service);
  const std::string prefix = interface + ".";
  const std::string provider_name = service.system + "/" + service.entity + "/";
  std::vector<view::ServiceId> offered;
  for (const std::string& operation : operations_of(types, interface)) {
    const std::string type = prefix + operation;
    offered.push_back(server_.add_service(
        {provider_name + type, type},
        [provider, operation](std::string_view request, const view::Answer& answer) {
          provider->call(operation, request, answer);
        }));
  }
  return offered;
}

}  // namespace skein::command

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
  for (const auto& service : broker.all()) {
    const Guid provider{service->provider};
    if (!service->owner.empty()) continue;  // its entity's alone
    if (offered_.contains(provider) || late_.contains(provider) || offer(*service)) continue;
    late_.insert(provider);
    return;
  }
  late_.clear();
}

bool ServiceFeed::offer(const discovery::ServiceDescription& service) {
  const Guid provider{service.provider};
  const auto participant = entity_.broker().participant_of(provider);
  if (!participant) return true;  // it has just gone
  try {
    offered_.emplace(
        provider, offer(service, inspector_.types(service.service, *participant, kServiceWithin)));
  } catch (const Unavailable& error) {
    log(LogLevel::Warning, "view",
        printable(service.service + ": " + error.what(), kLongestExplanation));
    return false;
  } catch (const InvalidArgument& error) {  // what was told makes no sense
    offered_.emplace(provider, std::vector<view::ServiceId>());
    log(LogLevel::Warning, "view",
        printable(service.service + " is not offered: " + error.what(), kLongestExplanation));
  }
  return true;
}

std::vector<view::ServiceId> ServiceFeed::offer(const discovery::ServiceDescription& service,
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

#include "view/server_messages.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "view/server.hpp"

namespace skein::view {
namespace {

using Json = nlohmann::ordered_json;

constexpr char kMessageData = 1;
constexpr char kCallResponse = 3;

/// Text that is no UTF-8 would be refused.
Frame text_message(const Json& message) {
  return {true,
          {},
          std::make_shared<const std::string>(
              message.dump(-1, ' ', false, Json::error_handler_t::replace))};
}

Json ends_of(const Graph::Ends& ends, const char* ids) {
  auto list = Json::array();
  for (const auto& [what, who] : ends) list.push_back({{"name", what}, {ids, who}});
  return list;
}

Json format_of(const std::string& type, const std::string& schema) {
  return {{"encoding", kCallEncoding},
          {"schemaName", type},
          {"schemaEncoding", "jsonschema"},
          {"schema", schema}};
}

/// Little-endian.
template <class Number>
void append(std::string& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof number; ++i) {
    bytes += static_cast<char>(number >> (8 * i) & 0xFF);
  }
}

}  // namespace

Frame server_info(const std::string& name, const std::string& session) {
  return text_message({{"op", "serverInfo"},
                       {"name", name},
                       {"capabilities", Json::array({"connectionGraph", "services"})},
                       {"supportedEncodings", Json::array({kCallEncoding})},
                       {"sessionId", session}});
}

Frame status(Level level, const std::string& text, const std::string& id) {
  Json message{{"op", "status"}, {"level", static_cast<std::uint32_t>(level)}, {"message", text}};
  if (!id.empty()) message["id"] = id;
  return text_message(message);
}

Frame advertise(const std::map<std::uint32_t, const Channel*>& channels) {
  auto list = Json::array();
  for (const auto& [id, channel] : channels) {
    list.push_back({{"id", id},
                    {"topic", channel->topic},
                    {"encoding", "cdr"},
                    {"schemaName", channel->type},
                    {"schemaEncoding", "omgidl"},
                    {"schema", channel->schema}});
  }
  return text_message({{"op", "advertise"}, {"channels", list}});
}

Frame unadvertise(std::uint32_t channel) {
  return text_message({{"op", "unadvertise"}, {"channelIds", Json::array({channel})}});
}

Frame advertise_services(const std::map<std::uint32_t, const Service*>& services) {
  auto list = Json::array();
  for (const auto& [id, service] : services) {
    list.push_back(
        {{"id", id},
         {"name", service->name},
         {"type", service->type},
         {"request", format_of(service->type + "_Request", service->request_schema)},
         {"response", format_of(service->type + "_Response", service->response_schema)}});
  }
  return text_message({{"op", "advertiseServices"}, {"services", list}});
}

Frame unadvertise_service(std::uint32_t service) {
  return text_message({{"op", "unadvertiseServices"}, {"serviceIds", Json::array({service})}});
}

Frame graph_update(const GraphChange& change) {
  return text_message({{"op", "connectionGraphUpdate"},
                       {"publishedTopics", ends_of(change.changed.publishers, "publisherIds")},
                       {"subscribedTopics", ends_of(change.changed.subscribers, "subscriberIds")},
                       {"advertisedServices", ends_of(change.changed.providers, "providerIds")},
                       {"removedTopics", change.removed_topics},
                       {"removedServices", change.removed_services}});
}

Frame message_data(std::uint32_t subscription, std::uint64_t time,
                   std::shared_ptr<const std::string> cdr) {
  std::string head(1, kMessageData);
  append(head, subscription);
  append(head, time);
  return {false, std::move(head), std::move(cdr)};
}

Frame call_response(std::uint32_t service, std::uint32_t call, std::string response) {
  std::string head(1, kCallResponse);
  append(head, service);
  append(head, call);
  append(head, static_cast<std::uint32_t>(kCallEncoding.size()));
  head += kCallEncoding;
  return {false, std::move(head), std::make_shared<const std::string>(std::move(response))};
}

Frame call_failure(std::uint32_t service, std::uint32_t call, const std::string& text) {
  return text_message(
      {{"op", "serviceCallFailure"}, {"serviceId", service}, {"callId", call}, {"message", text}});
}

}  // namespace skein::view

#include "view/server_messages.hpp"

#include <utility>

#include "skein/detail/json.hpp"
#include "view/server.hpp"

namespace skein::view {
namespace {

using idl::JsonWriter;

constexpr char kMessageData = 1;
constexpr char kCallResponse = 3;

/// A JSON message, to which `write` adds members.
template <class Write>
Frame text_message(std::string_view operation, const Write& write) {
  JsonWriter json;
  json.begin_object();
  json.key("op");
  json.write_string(operation);
  write(json);
  json.end_object();
  return {true, {}, std::make_shared<const std::string>(json.take())};
}

void write_member(JsonWriter& json, std::string_view name, std::string_view value) {
  json.key(name);
  json.write_string(value);
}

void write_member(JsonWriter& json, std::string_view name, std::uint32_t value) {
  json.key(name);
  json.write(value);
}

template <class Texts>
void write_list(JsonWriter& json, std::string_view name, const Texts& texts) {
  json.key(name);
  json.begin_array();
  for (const auto& text : texts) json.write_string(text);
  json.end_array();
}

void write_ends(JsonWriter& json, std::string_view name, std::string_view ids,
                const Graph::Ends& ends) {
  json.key(name);
  json.begin_array();
  for (const auto& [what, who] : ends) {
    json.begin_object();
    write_member(json, "name", what);
    write_list(json, ids, who);
    json.end_object();
  }
  json.end_array();
}

Frame withdrawal(std::string_view operation, std::string_view list, std::uint32_t id) {
  return text_message(operation, [&](JsonWriter& json) {
    json.key(list);
    json.begin_array();
    json.write(id);
    json.end_array();
  });
}

void write_format(JsonWriter& json, std::string_view name, const std::string& type,
                  const std::string& schema) {
  json.key(name);
  json.begin_object();
  write_member(json, "encoding", kCallEncoding);
  write_member(json, "schemaName", type);
  write_member(json, "schemaEncoding", "jsonschema");
  write_member(json, "schema", schema);
  json.end_object();
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
  return text_message("serverInfo", [&](JsonWriter& json) {
    write_member(json, "name", name);
    write_list(json, "capabilities", std::vector<std::string>{"connectionGraph", "services"});
    write_list(json, "supportedEncodings", std::vector<std::string_view>{kCallEncoding});
    write_member(json, "sessionId", session);
  });
}

Frame status(Level level, const std::string& text, const std::string& id) {
  return text_message("status", [&](JsonWriter& json) {
    write_member(json, "level", static_cast<std::uint32_t>(level));
    write_member(json, "message", text);
    if (!id.empty()) write_member(json, "id", id);
  });
}

Frame advertise(const std::map<std::uint32_t, const Channel*>& channels) {
  return text_message("advertise", [&](JsonWriter& json) {
    json.key("channels");
    json.begin_array();
    for (const auto& [id, channel] : channels) {
      json.begin_object();
      write_member(json, "id", id);
      write_member(json, "topic", channel->topic);
      write_member(json, "encoding", "cdr");
      write_member(json, "schemaName", channel->type);
      write_member(json, "schemaEncoding", "omgidl");
      write_member(json, "schema", channel->schema);
      json.end_object();
    }
    json.end_array();
  });
}

Frame unadvertise(std::uint32_t channel) {
  return withdrawal("unadvertise", "channelIds", channel);
}

Frame advertise_services(const std::map<std::uint32_t, const Service*>& services) {
  return text_message("advertiseServices", [&](JsonWriter& json) {
    json.key("services");
    json.begin_array();
    for (const auto& [id, service] : services) {
      json.begin_object();
      write_member(json, "id", id);
      write_member(json, "name", service->name);
      write_member(json, "type", service->type);
      write_format(json, "request", service->type + "_Request", service->request_schema);
      write_format(json, "response", service->type + "_Response", service->response_schema);
      json.end_object();
    }
    json.end_array();
  });
}

Frame unadvertise_service(std::uint32_t service) {
  return withdrawal("unadvertiseServices", "serviceIds", service);
}

Frame graph_update(const GraphChange& change) {
  return text_message("connectionGraphUpdate", [&](JsonWriter& json) {
    write_ends(json, "publishedTopics", "publisherIds", change.changed.publishers);
    write_ends(json, "subscribedTopics", "subscriberIds", change.changed.subscribers);
    write_ends(json, "advertisedServices", "providerIds", change.changed.providers);
    write_list(json, "removedTopics", change.removed_topics);
    write_list(json, "removedServices", change.removed_services);
  });
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
  return text_message("serviceCallFailure", [&](JsonWriter& json) {
    write_member(json, "serviceId", service);
    write_member(json, "callId", call);
    write_member(json, "message", text);
  });
}

}  // namespace skein::view

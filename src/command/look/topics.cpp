#include <cstdio>
#include <nlohmann/json.hpp>

#include "brokerless_discovery/broker.hpp"
#include "command/commands.hpp"
#include "command/print/interruption.hpp"
#include "command/print/json_output.hpp"
#include "core/printable.hpp"
#include "skein/entity.hpp"
#include "topic_findings.hpp"
#include "topic_survey.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kLongestVerdict = 1024;

std::string qos_words(const inspection::TopicEndpoint& endpoint) {
  std::string text = endpoint.reliable ? "reliable" : "best effort";
  if (endpoint.transient_local) text += ", kept for late joiners";
  if (endpoint.exclusive) text += ", exclusive";
  const auto add = [&](const char* name, const std::vector<std::uint64_t>& time) {
    if (!time.empty())
      text += std::string(", ") + name + " " + std::to_string(time[0] / 1'000'000) + " ms";
  };
  add("deadline", endpoint.deadline);
  add("lifespan", endpoint.lifespan);
  add("lease", endpoint.lease);
  return text;
}

void print_topic(const KnownTopic& topic) {
  std::string systems;
  for (const std::string& system : topic.systems())
    systems += (systems.empty() ? "" : ", ") + printable(system);
  std::printf("%-32s %s  in %s\n", printable(topic.name).c_str(), printable(topic.type).c_str(),
              systems.c_str());
  for (const auto& [participant, entity, told] : topic.endpoints) {
    std::printf("    %s %-28s %s; %llu %s%s\n", told.publishes ? "published by " : "subscribed by",
                printable(entity).c_str(), qos_words(told).c_str(),
                static_cast<unsigned long long>(told.samples),
                told.publishes ? "published" : "received",
                told.matched == 0 ? "; matches nobody" : "");
  }
}

nlohmann::ordered_json json_of_topic(const KnownTopic& topic) {
  nlohmann::ordered_json json{{"name", topic.name}, {"type", topic.type}};
  for (const auto& [participant, entity, told] : topic.endpoints) {
    auto endpoint = command::json_of(told);
    endpoint["entity"] = entity;
    json["endpoints"].push_back(std::move(endpoint));
  }
  return json;
}

}  // namespace

int list_topics(const TopicsArguments& arguments) {
  const Interruption interruption;
  Entity entity = join(arguments, "topics");
  Inspector inspector(entity, interruption.gives_up());
  if (arguments.seconds > 0) interruption.wait(arguments.seconds);
  const auto topics = known_topics(inspector, kAnswerPatience);
  if (arguments.names) {
    for (const KnownTopic& topic : topics) std::printf("%s\n", printable(topic.name).c_str());
    if (topics.empty()) tell_missions_elsewhere(arguments);
    return 0;
  }
  if (arguments.json) {
    auto all = nlohmann::ordered_json::array();
    for (const KnownTopic& topic : topics) all.push_back(json_of_topic(topic));
    print_json(all, true);
    return 0;
  }
  std::vector<KnownTopic::Endpoint> endpoints;
  for (const KnownTopic& topic : topics) {
    print_topic(topic);
    endpoints.insert(endpoints.end(), topic.endpoints.begin(), topic.endpoints.end());
  }
  for (const std::string& conflict : topic_conflicts(endpoints, types_told_by(inspector)))
    std::printf("%s\n", printable(conflict, kLongestVerdict).c_str());
  for (const UnpublishedTopic& topic : unpublished_topics(endpoints))
    if (topic.misspelt) std::printf("%s\n", printable(topic.sentence, kLongestVerdict).c_str());
  std::printf("%zu %s in %s\n", topics.size(), topics.size() == 1 ? "topic" : "topics",
              entity.broker().options().place.c_str());
  if (topics.empty()) tell_missions_elsewhere(arguments);
  return 0;
}

}  // namespace skein::command

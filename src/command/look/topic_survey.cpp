#include "topic_survey.hpp"

#include <algorithm>
#include <cstdio>
#include <set>

#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "introspection/topic_witness.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

constexpr double kSurveyPeriod_s = 0.1;
constexpr std::size_t kLongestNotice = 1024;
/// After which it says what it waits for.
constexpr std::chrono::milliseconds kSilence{1500};
/// Of one round of questions.
constexpr std::chrono::milliseconds kShortest{100};
constexpr std::chrono::milliseconds kLongest{1000};

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + printable(name);
  return list.empty() ? "none" : list;
}

std::vector<std::string> topic_names(const std::vector<KnownTopic>& topics) {
  std::vector<std::string> names;
  for (const KnownTopic& topic : topics) names.push_back(topic.name);
  return names;
}

}  // namespace

KnownTopic await_topic(Inspector& inspector, const std::string& name, double seconds,
                       const Interruption& interruption) {
  using std::chrono::steady_clock;
  const auto begin = steady_clock::now();
  const auto end =
      begin + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds));
  bool told = false;
  std::vector<KnownTopic> topics;
  while (true) {
    topics = known_topics(inspector,
                          std::clamp<Duration>(end - steady_clock::now(), kShortest, kLongest));
    std::vector<KnownTopic> found;
    std::ranges::copy_if(topics, std::back_inserter(found),
                         [&](const KnownTopic& topic) { return topic.name == name; });
    if (found.size() == 1) return found.front();
    if (found.size() > 1) {
      throw InvalidArgument("topic '" + name + "' has several types here: " +
                            printable(found[0].type) + " and " + printable(found[1].type));
    }
    const auto now = steady_clock::now();
    if (now >= end) break;
    if (!told && now - begin >= kSilence) {
      told = true;
      std::fprintf(stderr, "skein: waiting for the topic '%s'%s\n", printable(name).c_str(),
                   suggestion(name, topic_names(topics)).c_str());
    }
    if (interruption.wait(kSurveyPeriod_s)) {
      throw Interrupted("interrupted while it looked for the topic '" + name + "'",
                        interruption.signal());
    }
  }
  throw Unavailable("no entity here has a topic '" + name + "'" +
                    suggestion(name, topic_names(topics)) + "; there are " +
                    list_of(topic_names(topics)));
}

types::TypeSystem types_of(Inspector& inspector, const KnownTopic& topic, bool publishers) {
  return inspector.types(topic.type, witness_of(topic, publishers), kAnswerPatience);
}

TellTypes types_told_by(Inspector& inspector) {
  return [&inspector, silent = std::set<Guid>()](
             const KnownTopic::Endpoint& asked) mutable -> std::optional<types::TypeSystem> {
    if (silent.contains(asked.participant)) return std::nullopt;
    try {
      return inspector.types(asked.told.type, asked.participant, kAnswerPatience);
    } catch (const Unavailable&) {
      silent.insert(asked.participant);
      return std::nullopt;
    }
  };
}

void tell_conflicts(Inspector& inspector, const KnownTopic& topic) {
  for (const std::string& conflict : topic_conflicts(topic.endpoints, types_told_by(inspector)))
    std::fprintf(stderr, "skein: %s\n", printable(conflict, kLongestNotice).c_str());
}

}  // namespace skein::command

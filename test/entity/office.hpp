#pragma once

#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "brokerless_discovery/broker.hpp"
#include "scripted_worker.hpp"
#include "skein/discovery.idl.hpp"
#include "test/connector/pairing.hpp"
#include "test/tools/eventually.hpp"

namespace skein::test {

using WorkTask = Task<crew::Worker, std::string>;

/// Where a CSP of the office lives.
enum class Place {
  Inside,   ///< With its owner: called without leaving the process.
  Outside,  ///< An entity of its own: called over the pairing's vendors.
};

inline ServiceOptions declared(const std::string& latency_ms, const std::string& quality) {
  ServiceOptions options;
  options.attributes = {{"latency", latency_ms}, {"quality", quality}};
  return options;
}

/// An autonomous entity whose Head is tested, and its CSPs.
class Office {
 public:
  explicit Office(HeadOptions head = {})
      : owner(make_entity("office", Pairing::get().server, "uav-1", nullptr, std::move(head))) {}

  /// Adds a CSP and waits until the Head could select it.
  std::shared_ptr<ScriptedWorker> add(const std::string& name, Place place,
                                      ScriptedWorker::Script script,
                                      const ServiceOptions& options) {
    auto worker = std::make_shared<ScriptedWorker>(std::move(script));
    Entity* host = owner.get();
    if (place == Place::Outside) {
      outside.push_back(make_entity(name + "-host", Pairing::get().client));
      host = outside.back().get();
    }
    ids[name] = {host, host->provide_csp<crew::Worker>(name, owner->id(), worker, options)};
    if (!eventually([&] { return is_available(name); }))
      throw std::runtime_error(name + " was never seen");
    return worker;
  }

  void remove(const std::string& name) {
    const auto [host, id] = ids.at(name);
    host->withdraw(id);
  }

  bool is_available(const std::string& name) const {
    for (const auto& csp : owner->broker().find_service(owner->broker().query("crew/Worker"))) {
      if (csp->entity == name) return true;
    }
    return false;
  }

  /// Available, or is suspect and may be available again.
  bool knows(const std::string& name) const { return owner->broker().knows(ids.at(name).second); }

  /// A task that hands `text` to the CSP, accepts what begins with a name, and never blocks on a
  /// CSP in the process.
  static WorkTask task(const std::string& text = "it") {
    WorkTask task;
    task.run = [text](crew::Worker::Proxy& worker, Duration) {
      return worker.async_work(text).get();
    };
    task.evaluate = [](const std::string& result) {
      return result.starts_with("wrong") ? std::optional<std::string>("it is " + result)
                                         : std::nullopt;
    };
    task.settles = [](const UserException& exception, const Candidate&) {
      const auto* no_answer = dynamic_cast<const crew::NoAnswer*>(&exception);
      return no_answer && no_answer->final_word;
    };
    return task;
  }

  std::string perform(const WorkTask& task, Duration limit) {
    return owner->head().perform(task, &record, limit);
  }

  /// `NAME outcome` of each attempt, in order.
  std::vector<std::string> attempts() const {
    std::vector<std::string> lines;
    for (const introspection::Attempt& attempt : record.attempts)
      lines.push_back(attempt.csp + " " + in_words(attempt.outcome));
    return lines;
  }

  /// The attempt of that CSP; throws where there is none.
  const introspection::Attempt& attempt_of(const std::string& csp) const {
    for (const introspection::Attempt& attempt : record.attempts) {
      if (attempt.csp == csp) return attempt;
    }
    throw std::runtime_error(csp + " was not tried");
  }

  /// What the last decision took.
  std::chrono::nanoseconds took() const { return std::chrono::nanoseconds(record.took); }

  std::unique_ptr<Entity> owner;
  std::vector<std::unique_ptr<Entity>> outside;
  std::map<std::string, std::pair<Entity*, Guid>> ids;
  introspection::Decision record;
};

/// The Body of an office.
class OfficeBody final : public crew::Desk {
 public:
  explicit OfficeBody(Head& head) : head_(head) {}
  std::string ask(const std::string& text) override { return head_.perform(Office::task(text)); }

 private:
  Head& head_;
};

}  // namespace skein::test

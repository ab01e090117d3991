#include "skein/inspector.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "entity/asker.hpp"
#include "entity/entity_access.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"

namespace skein {

using inspection::Question;
using introspection::Asker;

struct Inspector::State {
  Asker asker;
};

Inspector::Inspector(Entity& entity, std::function<bool()> gives_up)
    : state_(new State{{EntityAccess::participant(entity), entity.clock(), std::move(gives_up)}}) {}
Inspector::~Inspector() = default;

std::vector<Inspected> Inspector::ask_all(inspection::Subject subject, Duration timeout) {
  Question question;
  question.subject = subject;
  Asker& asker = state_->asker;
  const auto answers = asker.ask(question, timeout, [&](const Asker::Answers& answers_) {
    return !asker.known().empty() && std::ranges::all_of(asker.known(), [&](const Guid& each) {
      return answers_.contains(each);
    });
  });
  std::vector<Inspected> all;
  for (const auto& [participant, answer] : answers) all.push_back({participant, answer});
  std::ranges::stable_sort(all, {}, [](const Inspected& each) { return each.answer.entity; });
  return all;
}

types::TypeSystem Inspector::types(const std::string& name, const Guid& participant,
                                   Duration timeout) {
  if (auto found = state_->asker.types(name, participant, timeout)) return std::move(*found);
  const auto waited = std::chrono::duration_cast<std::chrono::milliseconds>(timeout);
  throw Unavailable("nobody told the types of " + name + " within " +
                    std::to_string(waited.count()) + " ms" +
                    (participant.is_nil() ? "" : ": its provider did not answer"));
}

void Inspector::types(const std::vector<TypesWanted>& wanted, Duration timeout,
                      const std::function<void(std::size_t, const types::TypeSystem&)>& on_told) {
  Asker& asker = state_->asker;
  std::map<std::size_t, Asker::Asking> asked;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    Question question;
    question.subject = inspection::Subject::Types;
    question.participant = wanted[i].participant.participant().bytes;
    question.name = wanted[i].name;
    asked.try_emplace(i, asker, std::move(question));
  }
  const Instant deadline = asker.clock().after(timeout);
  const auto has_types = [](const auto& each) { return !each.second.types.empty(); };
  const auto first_told = [&] {
    return std::ranges::find_if(asked, [&](const auto& each) {
      return std::ranges::any_of(each.second.answers(), has_types);
    });
  };
  Instant next{};
  const auto send_all = [&] {
    const Instant now = asker.clock().now();
    if (now < next) return;
    next = now + Asker::kRepetition;
    for (auto& [index, asking] : asked) asking.send();
  };
  while (!asked.empty()) {
    asker.await(deadline - asker.clock().now(), send_all,
                [&] { return first_told() != asked.end(); });
    std::unique_lock lock = asker.lock();
    const auto told = first_told();
    if (told == asked.end()) return;
    const Asker::Answers answers = std::move(told->second.answers());
    lock.unlock();
    const std::size_t index = told->first;
    asked.erase(told);
    on_told(index, std::ranges::find_if(answers, has_types)->second.types.front());
  }
}

}  // namespace skein

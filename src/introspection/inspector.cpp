#include "skein/inspector.hpp"

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <set>

#include "core/clock_wait.hpp"
#include "entity/inspection_topic.hpp"
#include "idl/types/description_limits.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"

namespace skein {

using inspection::Answer;
using inspection::Question;
using introspection::kAnswers;
using introspection::kQuestions;

namespace {

/// What is lost, or asked before both sides have matched, is asked again.
constexpr std::chrono::milliseconds kRepetition{100};

}  // namespace

struct Inspector::State {
  explicit State(Entity& entity_) : entity(entity_) {
    dds::WriterListener listener;
    listener.on_matched = [this](const Guid& reader, bool matched) {
      std::lock_guard lock(mutex);
      const Guid participant = reader.participant();
      if (participant == entity.guid()) return;
      matched ? void(known.insert(participant)) : void(known.erase(participant));
      changed.notify_all();
    };
    reader = std::make_unique<introspection::AnyReader>(
        entity.participant(), kAnswers,
        introspection::AnyReader::Listener{[this](const dds::Sample& sample) { receive(sample); }});
    writer = entity.participant().create_writer(kQuestions.dds_topic(), kQuestions.qos(),
                                                std::move(listener));
  }

  void receive(const dds::Sample& sample) {
    if (sample.state != dds::InstanceState::Alive) return;
    auto answer = introspection::decoded<Answer>(sample);
    const Guid participant = sample.writer.participant();
    if (answer.asker != asker.bytes || participant == entity.guid()) return;
    for (const types::TypeSystem& told : answer.types) idl::check_limits(told);
    std::lock_guard lock(mutex);
    const auto asked = waiting.find(answer.number);
    if (asked == waiting.end()) return;
    const Guid& wanted = asked->second.participant;
    if (!wanted.is_nil() && wanted != participant) {
      throw InvalidArgument("it answers a question that was put to another one");
    }
    asked->second.answers.emplace(participant, std::move(answer));
    changed.notify_all();
  }

  using Answers = std::map<Guid, Answer>;
  struct Asked {
    Guid participant;  // whose answer is wanted; nil: everybody's
    Answers answers{};
  };

  /// Forgets a question when who asked it waits no longer.
  struct Waiting {
    Waiting(State& state_, std::unique_lock<std::mutex>& lock_, std::uint32_t number_)
        : state(state_), lock(lock_), number(number_) {}
    ~Waiting() {
      if (!lock.owns_lock()) lock.lock();
      state.waiting.erase(number);
    }
    Waiting(const Waiting&) = delete;
    Waiting& operator=(const Waiting&) = delete;

    State& state;
    std::unique_lock<std::mutex>& lock;
    const std::uint32_t number;
  };

  /// Waits until `complete(answers)`, under the lock; asks those again that have not answered.
  template <class Complete>
  Answers ask(Question question, Duration timeout, const Complete& complete) {
    std::unique_lock lock(mutex);
    question.asker = asker.bytes;
    question.number = ++last;
    const Waiting entry(*this, lock, question.number);
    Answers& answers =
        waiting.emplace(question.number, Asked{Guid{question.participant}}).first->second.answers;
    const Instant deadline = entity.clock().after(timeout);
    bool first = true;
    while (!complete(answers)) {
      lock.unlock();
      send(question, first ? std::vector<Guid>() : missing(answers));
      lock.lock();
      first = false;
      const Instant again = std::min(deadline, entity.clock().after(kRepetition));
      wait_until(entity.clock(), again, lock, changed, [&] { return complete(answers); });
      if (entity.clock().now() >= deadline) break;
    }
    return std::move(answers);
  }

  std::vector<Guid> missing(const Answers& answers) {
    std::lock_guard lock(mutex);
    std::vector<Guid> others;
    std::ranges::copy_if(known, std::back_inserter(others),
                         [&](const Guid& each) { return !answers.contains(each); });
    return others;
  }

  /// To all that it is meant for, or again to some of them.
  void send(Question question, const std::vector<Guid>& again) const {
    if (again.empty() || question.participant != Guid{}.bytes) {
      writer->write(idl::encode_message(question));
      return;
    }
    for (const Guid& participant : again) {
      question.participant = participant.bytes;
      writer->write(idl::encode_message(question));
    }
  }

  Entity& entity;
  const Guid asker = Guid::random();
  std::mutex mutex;
  std::condition_variable changed;
  std::set<Guid> known;  // participants that can be asked
  std::map<std::uint32_t, Asked> waiting;
  std::uint32_t last = 0;
  // These go first: their listeners use the rest.
  std::unique_ptr<introspection::AnyReader> reader;
  std::unique_ptr<dds::Writer> writer;
};

Inspector::Inspector(Entity& entity) : state_(std::make_unique<State>(entity)) {}
Inspector::~Inspector() = default;

std::vector<Inspected> Inspector::ask_all(inspection::Subject subject, Duration timeout) {
  Question question;
  question.subject = subject;
  const auto answers = state_->ask(question, timeout, [this](const State::Answers& answers_) {
    return !state_->known.empty() && std::ranges::all_of(state_->known, [&](const Guid& each) {
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
  Question question;
  question.subject = inspection::Subject::Types;
  question.participant = participant.participant().bytes;
  question.name = name;
  const auto has_types = [](const auto& each) { return !each.second.types.empty(); };
  const auto answers = state_->ask(question, timeout, [&](const State::Answers& answers_) {
    return std::ranges::any_of(answers_, has_types);
  });
  const auto found = std::ranges::find_if(answers, has_types);
  if (found != answers.end()) return found->second.types.front();
  const auto waited = std::chrono::duration_cast<std::chrono::milliseconds>(timeout);
  throw Unavailable("nobody told the types of " + name + " within " +
                    std::to_string(waited.count()) + " ms" +
                    (participant.is_nil() ? "" : ": its provider did not answer"));
}

}  // namespace skein

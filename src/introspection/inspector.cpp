#include "skein/inspector.hpp"

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "core/clock_wait.hpp"
#include "dds/port/options_check.hpp"
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

/// Whether a vendor takes its names. Sound entities have no other topics.
bool has_names_of_dds(const inspection::TopicEndpoint& told) {
  return dds::is_topic_name(told.name) && dds::is_type_name(told.type) &&
         std::ranges::all_of(told.systems, dds::is_partition);
}

}  // namespace

struct Inspector::State {
  State(Entity& entity_, std::function<bool()> gives_up_)
      : entity(entity_), gives_up(std::move(gives_up_)) {
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
    std::erase_if(answer.topics, [](const auto& told) { return !has_names_of_dds(told); });
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

  /// A question, which is forgotten with this object.
  class Asking {
   public:
    Asking(State& state, Question question) : state_(state), question_(std::move(question)) {
      std::lock_guard lock(state.mutex);
      question_.asker = state.asker.bytes;
      question_.number = ++state.last;
      answers_ = &state.waiting.emplace(question_.number, Asked{Guid{question_.participant}})
                      .first->second.answers;
    }
    ~Asking() {
      std::lock_guard lock(state_.mutex);
      state_.waiting.erase(question_.number);
    }
    Asking(const Asking&) = delete;
    Asking& operator=(const Asking&) = delete;

    /// Under the lock.
    Answers& answers() const noexcept { return *answers_; }

    /// To all that it is meant for, or again to those that have not answered.
    void send() {
      const auto again = std::exchange(first_, false) ? std::vector<Guid>() : missing();
      if (again.empty() || question_.participant != Guid{}.bytes) return write(question_);
      Question question = question_;
      for (const Guid& participant : again) {
        question.participant = participant.bytes;
        write(question);
      }
    }

   private:
    void write(const Question& question) const {
      state_.writer->write(idl::encode_message(question));
    }

    std::vector<Guid> missing() const {
      std::lock_guard lock(state_.mutex);
      std::vector<Guid> others;
      std::ranges::copy_if(state_.known, std::back_inserter(others),
                           [&](const Guid& each) { return !answers_->contains(each); });
      return others;
    }

    State& state_;
    Question question_;
    Answers* answers_;
    bool first_ = true;
  };

  /// Waits until `complete()`, under the lock. In between it calls `ask`, without the lock.
  template <class Ask, class Complete>
  void await(Duration timeout, const Ask& ask, const Complete& complete) {
    std::unique_lock lock(mutex);
    const Instant deadline = entity.clock().after(timeout);
    while (!complete()) {
      lock.unlock();
      ask();
      const bool patient = !gives_up || !gives_up();
      lock.lock();
      const Instant again = std::min(deadline, entity.clock().after(kRepetition));
      if (patient) wait_until(entity.clock(), again, lock, changed, complete);
      if (!patient || entity.clock().now() >= deadline) break;
    }
  }

  template <class Complete>
  Answers ask(Question question, Duration timeout, const Complete& complete) {
    Asking asking(*this, std::move(question));
    await(
        timeout, [&] { asking.send(); }, [&] { return complete(asking.answers()); });
    std::lock_guard lock(mutex);
    return std::move(asking.answers());
  }

  Entity& entity;
  const std::function<bool()> gives_up;
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

Inspector::Inspector(Entity& entity, std::function<bool()> gives_up)
    : state_(std::make_unique<State>(entity, std::move(gives_up))) {}
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
  std::optional<types::TypeSystem> found;
  types({{name, participant}}, timeout,
        [&](std::size_t, const types::TypeSystem& told) { found = told; });
  if (found) return std::move(*found);
  const auto waited = std::chrono::duration_cast<std::chrono::milliseconds>(timeout);
  throw Unavailable("nobody told the types of " + name + " within " +
                    std::to_string(waited.count()) + " ms" +
                    (participant.is_nil() ? "" : ": its provider did not answer"));
}

void Inspector::types(const std::vector<TypesWanted>& wanted, Duration timeout,
                      const std::function<void(std::size_t, const types::TypeSystem&)>& on_told) {
  std::map<std::size_t, State::Asking> asked;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    Question question;
    question.subject = inspection::Subject::Types;
    question.participant = wanted[i].participant.participant().bytes;
    question.name = wanted[i].name;
    asked.try_emplace(i, *state_, std::move(question));
  }
  const Instant deadline = state_->entity.clock().after(timeout);
  const auto has_types = [](const auto& each) { return !each.second.types.empty(); };
  const auto first_told = [&] {
    return std::ranges::find_if(asked, [&](const auto& each) {
      return std::ranges::any_of(each.second.answers(), has_types);
    });
  };
  Instant next{};
  const auto send_all = [&] {
    const Instant now = state_->entity.clock().now();
    if (now < next) return;
    next = now + kRepetition;
    for (auto& [index, asking] : asked) asking.send();
  };
  while (!asked.empty()) {
    state_->await(deadline - state_->entity.clock().now(), send_all,
                  [&] { return first_told() != asked.end(); });
    std::unique_lock lock(state_->mutex);
    const auto told = first_told();
    if (told == asked.end()) return;
    const State::Answers answers = std::move(told->second.answers());
    lock.unlock();
    const std::size_t index = told->first;
    asked.erase(told);
    on_told(index, std::ranges::find_if(answers, has_types)->second.types.front());
  }
}

}  // namespace skein

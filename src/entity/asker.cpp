#include "asker.hpp"

#include <algorithm>
#include <iterator>

#include "core/clock_wait.hpp"
#include "dds/port/options_check.hpp"
#include "idl/types/description_limits.hpp"
#include "inspection_topic.hpp"
#include "skein/error.hpp"

namespace skein::introspection {
namespace {

using inspection::Question;

/// Whether a vendor takes its names. Sound entities have no other topics.
bool has_names_of_dds(const inspection::TopicEndpoint& told) {
  return dds::is_topic_name(told.name) && dds::is_type_name(told.type) &&
         std::ranges::all_of(told.systems, dds::is_partition);
}

bool has_types(const Asker::Answers::value_type& each) { return !each.second.types.empty(); }

}  // namespace

Asker::Asking::Asking(Asker& asker, Question question)
    : asker_(asker), question_(std::move(question)) {
  std::lock_guard lock(asker.mutex_);
  question_.asker = asker.name_.bytes;
  question_.number = ++asker.last_;
  answers_ = &asker.waiting_.emplace(question_.number, Asked{Guid{question_.participant}})
                  .first->second.answers;
}

Asker::Asking::~Asking() {
  std::lock_guard lock(asker_.mutex_);
  asker_.waiting_.erase(question_.number);
}

void Asker::Asking::send() {
  const auto again = std::exchange(first_, false) ? std::vector<Guid>() : missing();
  if (again.empty() || question_.participant != Guid{}.bytes) return write(question_);
  Question question = question_;
  for (const Guid& participant : again) {
    question.participant = participant.bytes;
    write(question);
  }
}

void Asker::Asking::write(const Question& question) const {
  asker_.writer_->write(idl::encode_message(question));
}

std::vector<Guid> Asker::Asking::missing() const {
  std::lock_guard lock(asker_.mutex_);
  std::vector<Guid> others;
  std::ranges::copy_if(asker_.known_, std::back_inserter(others),
                       [&](const Guid& each) { return !answers_->contains(each); });
  return others;
}

Asker::Asker(dds::Participant& participant, Clock& clock, std::function<bool()> gives_up)
    : participant_(participant), clock_(clock), gives_up_(std::move(gives_up)) {
  dds::WriterListener listener;
  listener.on_matched = [this](const Guid& reader, bool matched) { on_matched(reader, matched); };
  reader_ = std::make_unique<AnyReader>(
      participant, kAnswers,
      AnyReader::Listener{[this](const dds::Sample& sample) { receive(sample); }});
  writer_ =
      participant.create_writer(kQuestions.dds_topic(), kQuestions.qos(), std::move(listener));
}

void Asker::on_matched(const Guid& reader, bool matched) {
  std::lock_guard lock(mutex_);
  const Guid participant = reader.participant();
  if (participant == participant_.guid().participant()) return;
  matched ? void(known_.insert(participant)) : void(known_.erase(participant));
  changed_.notify_all();
}

void Asker::receive(const dds::Sample& sample) {
  if (sample.state != dds::InstanceState::Alive) return;
  auto answer = decoded<inspection::Answer>(sample);
  const Guid participant = sample.writer.participant();
  if (answer.asker != name_.bytes || participant == participant_.guid().participant()) return;
  std::erase_if(answer.topics, [](const auto& told) { return !has_names_of_dds(told); });
  for (const types::TypeSystem& told : answer.types) idl::check_limits(told);
  std::lock_guard lock(mutex_);
  const auto asked = waiting_.find(answer.number);
  if (asked == waiting_.end()) return;
  const Guid& wanted = asked->second.participant;
  if (!wanted.is_nil() && wanted != participant) {
    throw InvalidArgument("it answers a question that was put to another one");
  }
  asked->second.answers.emplace(participant, std::move(answer));
  changed_.notify_all();
}

void Asker::await(Duration timeout, const std::function<void()>& ask,
                  const std::function<bool()>& complete) {
  std::unique_lock lock(mutex_);
  const Instant deadline = clock_.after(timeout);
  while (!complete()) {
    lock.unlock();
    ask();
    const bool patient = !gives_up_ || !gives_up_();
    lock.lock();
    const Instant again = std::min(deadline, clock_.after(kRepetition));
    if (patient) wait_until(clock_, again, lock, changed_, complete);
    if (!patient || clock_.now() >= deadline) break;
  }
}

Asker::Answers Asker::ask(Question question, Duration timeout,
                          const std::function<bool(const Answers& answers)>& complete) {
  Asking asking(*this, std::move(question));
  await(
      timeout, [&] { asking.send(); }, [&] { return complete(asking.answers()); });
  std::lock_guard lock(mutex_);
  return std::move(asking.answers());
}

std::optional<types::TypeSystem> Asker::types(const std::string& name, const Guid& participant,
                                              Duration timeout) {
  Question question;
  question.subject = inspection::Subject::Types;
  question.participant = participant.participant().bytes;
  question.name = name;
  const Answers answers = ask(std::move(question), timeout, [](const Answers& told) {
    return std::ranges::any_of(told, has_types);
  });
  const auto told = std::ranges::find_if(answers, has_types);
  if (told == answers.end()) return std::nullopt;
  return told->second.types.front();
}

}  // namespace skein::introspection

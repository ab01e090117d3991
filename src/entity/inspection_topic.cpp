#include "inspection_topic.hpp"

#include <utility>

namespace skein::introspection {

Answerer::Answerer(dds::Participant& participant, Executor& control, std::string entity,
                   Source source)
    : self_(participant.guid().participant()),
      entity_(std::move(entity)),
      source_(std::move(source)),
      publisher_(participant, control, kAnswers),
      reader_(std::make_unique<AnyReader>(
          participant, kQuestions,
          AnyReader::Listener{[this](const dds::Sample& sample) { receive(sample); }})) {}

Answerer::~Answerer() {
  reader_.reset();
  publisher_.close();
}

void Answerer::receive(const dds::Sample& sample) {
  if (sample.state != dds::InstanceState::Alive) return;
  auto question = decoded<inspection::Question>(sample);
  const Guid wanted{question.participant};
  if (!wanted.is_nil() && wanted != self_) return;
  if (waiting_.fetch_add(1) >= kMostWaiting) {
    --waiting_;
    return;
  }
  publisher_.post([this, question = std::move(question)] {
    --waiting_;
    answer(question);
  });
}

void Answerer::answer(const inspection::Question& question) {
  inspection::Answer answer;
  if (!source_(question, answer)) return;
  answer.asker = question.asker;
  answer.number = question.number;
  answer.entity = entity_;
  publisher_.publish(std::move(answer));
}

}  // namespace skein::introspection

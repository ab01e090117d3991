#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "rpc/service/introspection_topic.hpp"
#include "skein/inspection.idl.hpp"

namespace skein::introspection {

inline constexpr Topic<inspection::Question> kQuestions{
    {"skein/questions", "skein::inspection::Question", false, 64, true}};
inline constexpr Topic<inspection::Answer> kAnswers{
    {"skein/answers", "skein::inspection::Answer", false, 64, true}};

/// Answers what others ask of an entity.
class Answerer {
 public:
  /// Fills in an answer, on `control`; false where the entity has none.
  using Source =
      std::function<bool(const inspection::Question& question, inspection::Answer& answer)>;

  /// `participant` and `control` live until the end of this. `entity` is `system/name`.
  Answerer(dds::Participant& participant, Executor& control, std::string entity, Source source);
  ~Answerer();
  Answerer(const Answerer&) = delete;
  Answerer& operator=(const Answerer&) = delete;

 private:
  /// Further ones are dropped: who asked asks again.
  static constexpr int kMostWaiting = 64;

  void receive(const dds::Sample& sample);
  void answer(const inspection::Question& question);

  const Guid self_;
  const std::string entity_;
  const Source source_;
  std::atomic<int> waiting_{0};
  Publisher<inspection::Answer> publisher_;
  std::unique_ptr<AnyReader> reader_;
};

}  // namespace skein::introspection

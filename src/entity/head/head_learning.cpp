#include "head_learning.hpp"

#include "core/log.hpp"
#include "core/system/whole_file.hpp"
#include "selection/service_history.hpp"
#include "skein/error.hpp"

namespace skein::entity {

using introspection::Outcome;

HeadLearning::HeadLearning(std::string entity, std::string file)
    : entity_(std::move(entity)), file_(std::move(file)) {
  if (file_.empty()) return;
  history_ = History::load(file_);
  try_whole_file("the Head's history", file_);
  history_.learn();
}

HeadLearning::~HeadLearning() {
  learner_.reset();
  if (file_.empty()) return;
  try {
    history_.save(file_);
  } catch (const Error& error) {
    log(LogLevel::Error, entity_, error.what());
  }
}

PastDecisions HeadLearning::begin_request(std::string_view interface) {
  std::lock_guard lock(mutex_);
  const PastDecisions before = history_.decisions(interface);
  history_.begin(interface);
  return before;
}

void HeadLearning::predict(const InterfaceInfo& interface, const Features& features,
                           std::vector<Candidate>& candidates) const {
  std::vector<std::string_view> names;
  names.reserve(candidates.size());
  for (const Candidate& candidate : candidates) names.push_back(candidate.name);
  std::lock_guard lock(mutex_);
  auto predictions = history_.predict(interface.name, names, features);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    candidates[i].learned = std::move(predictions[i]);
}

void HeadLearning::add(const InterfaceInfo& interface, const Candidate& candidate,
                       const std::shared_ptr<const Features>& features, const RunEnding& ending) {
  if (ending.own) return;
  const bool overran = ending.expected > Duration::zero() && ending.took > ending.expected;
  const bool late =
      ending.outcome == Outcome::TimedOut || (ending.outcome == Outcome::Cancelled && overran);
  if (ending.outcome == Outcome::Cancelled && !late) return;
  const bool answered = ending.outcome == Outcome::Accepted || ending.settled;
  std::lock_guard lock(mutex_);
  history_.add(
      interface.name, candidate.name,
      {features, ending.took, answered, late, ending.quality, ending.request, ending.after},
      candidate.learned ? &*candidate.learned : nullptr);
}

void HeadLearning::end_request(const std::string& interface, bool explored) {
  std::lock_guard lock(mutex_);
  if (explored) history_.note_exploration(interface);
  if (learns_) return;  // one lesson at a time
  const auto lesson = history_.next_lesson(interface);
  if (!lesson) return;
  if (!learner_) learner_ = std::make_unique<ThreadExecutor>("skein-learn");
  learns_ = learner_->post([this, lesson] {
    lesson->learn();
    std::lock_guard lock(mutex_);
    history_.take(*lesson);
    learns_ = false;
  });
}

History HeadLearning::history() const {
  std::lock_guard lock(mutex_);
  return history_;
}

}  // namespace skein::entity

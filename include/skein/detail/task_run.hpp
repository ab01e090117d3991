#pragma once

#include <cmath>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/detail/channel.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"
#include "skein/task.hpp"

/// A running task as the Head sees it, without its types. Used by Head::perform().
namespace skein::task_run {

/// The judgement of a CSP's answer.
struct Verdict {
  introspection::Outcome outcome = introspection::Outcome::Failed;
  std::string check{};
  std::string text{};
  std::optional<double> quality{};
  std::exception_ptr error{};
  bool fault = true;     ///< Counts as a fault of the CSP.
  bool settled = false;  ///< No other CSP is to be asked.
  bool own = false;      ///< The Body's own functions failed: says nothing of the CSP.
};

/// The verdict for the exception that is being handled.
Verdict verdict_of_current_exception();

/// Throws on what `thrown` is, with `WHO threw: ` before its text: an Error of its class, a
/// UserException as it is, all else as Internal.
[[noreturn]] void throw_as_thrown_by(const std::string& who, const std::exception_ptr& thrown);

/// The verdict where `who`, a function of the Body's, has thrown `thrown`.
Verdict verdict_on_body(const std::string& who, const std::exception_ptr& thrown);

/// One CSP at work; destroying it cancels its call.
class Work {
 public:
  virtual ~Work() = default;
  virtual bool ready() = 0;
  /// Whether the task's `run` itself waited for the result.
  virtual bool waited() const = 0;
  virtual void notify(std::function<void()> action) = 0;
  /// Waits for the answer and judges it; an accepted result is kept.
  virtual Verdict judge() = 0;
};

class TaskRun {
 public:
  virtual ~TaskRun() = default;
  virtual const TaskOptions& options() const noexcept = 0;
  virtual std::unique_ptr<Work> begin(std::shared_ptr<Channel> channel, Duration budget,
                                      const Candidate& candidate) = 0;
  virtual std::size_t accepted() const noexcept = 0;
  /// Tries to make the result from the accepted ones; returns how, in words, or nullopt if they are
  /// not sufficient.
  virtual std::optional<std::string> synthesise() = 0;
};

template <class Interface, class Result>
class TypedRun final : public TaskRun {
 public:
  explicit TypedRun(const Task<Interface, Result>& task) : task_(task) {
    if (!task.run) throw InvalidArgument("the task has no `run`, which calls the CSP");
  }

  const TaskOptions& options() const noexcept override { return task_; }
  std::unique_ptr<Work> begin(std::shared_ptr<Channel> channel, Duration budget,
                              const Candidate& candidate) override {
    return std::make_unique<TypedWork>(*this, std::move(channel), budget, candidate);
  }
  std::size_t accepted() const noexcept override { return opinions_.size(); }

  std::optional<std::string> synthesise() override {
    if (opinions_.empty()) return std::nullopt;
    if (task_.synthesis) {
      auto made = combine();
      if (!made) return std::nullopt;
      result_ = std::move(made->result);
      return std::move(made->how);
    }
    result_ = std::move(opinions_[best_].result);
    return opinions_.size() == 1
               ? ""
               : opinions_[best_].csp + " gave the best of " + std::to_string(opinions_.size());
  }

  Result take() { return std::move(*result_); }

 private:
  class TypedWork final : public Work {
   public:
    TypedWork(TypedRun& run, std::shared_ptr<Channel> channel, Duration budget,
              const Candidate& candidate)
        : run_(run), candidate_(candidate) {
      try {
        typename Interface::Proxy proxy(std::move(channel), budget);
        answer_.emplace(run.task_.run(proxy, budget));
      } catch (const UserException&) {
        error_ = std::current_exception();
      } catch (const Error&) {
        error_ = std::current_exception();
      } catch (...) {  // no call ends so
        error_ = std::current_exception();
        own_ = true;
      }
    }

    bool ready() override { return error_ || answer_->ready(); }
    bool waited() const override { return answer_ && answer_->waited(); }
    void notify(std::function<void()> action) override { answer_->notify(std::move(action)); }

    Verdict judge() override {
      if (own_) return verdict_on_body("the task's `run`", error_);
      std::optional<Result> result;
      try {
        if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
        result.emplace(answer_->get());
      } catch (const UserException& exception) {
        return refused(exception);
      } catch (...) {
        return verdict_of_current_exception();
      }
      return run_.judge(candidate_, std::move(*result));
    }

   private:
    /// Of the exception that is being handled.
    Verdict refused(const UserException& exception) {
      Verdict verdict = verdict_of_current_exception();
      try {
        verdict.settled = run_.task_.settles && run_.task_.settles(exception, candidate_);
      } catch (...) {
        return verdict_on_body("the task's `settles`", std::current_exception());
      }
      return verdict;
    }

    TypedRun& run_;
    const Candidate candidate_;
    std::optional<Awaited<Result>> answer_;
    std::exception_ptr error_;
    bool own_ = false;  // the error is none of the call's
  };

  auto combine() const {
    try {
      return task_.synthesis(opinions_);
    } catch (...) {
      throw_as_thrown_by("the task's `synthesis`", std::current_exception());
    }
  }

  Verdict judge(const Candidate& candidate, Result result) {
    Verdict verdict;
    if (auto rejection = task_.evaluate(result)) {
      if (rejection->thrown) {
        verdict = verdict_on_body("the check '" + rejection->check + "'", rejection->thrown);
        verdict.check = std::move(rejection->check);
        return verdict;
      }
      verdict.outcome = introspection::Outcome::Rejected;
      verdict.check = std::move(rejection->check);
      verdict.text = std::move(rejection->reason);
      verdict.fault = rejection->fault;
      return verdict;
    }
    try {
      if (task_.quality) verdict.quality = task_.quality(result);
    } catch (...) {
      return verdict_on_body("the task's `quality`", std::current_exception());
    }
    if (!std::isfinite(verdict.quality.value_or(0))) return without_quality();
    verdict.outcome = introspection::Outcome::Accepted;
    verdict.fault = false;
    const double quality = verdict.quality.value_or(0);
    if (opinions_.empty() || quality > best_quality_) {
      best_ = opinions_.size();
      best_quality_ = quality;
    }
    opinions_.push_back({candidate.name, std::move(result)});
    return verdict;
  }

  /// Nothing compares with it: neither this result nor the CSP's next ones could be judged.
  static Verdict without_quality() {
    Verdict verdict;
    verdict.outcome = introspection::Outcome::Rejected;
    verdict.check = "quality";
    verdict.text = "its quality is no finite number";
    return verdict;
  }

  const Task<Interface, Result>& task_;
  std::vector<Opinion<Result>> opinions_;
  std::size_t best_ = 0;
  double best_quality_ = 0;
  std::optional<Result> result_;
};

}  // namespace skein::task_run

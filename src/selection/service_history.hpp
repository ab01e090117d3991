#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "forest.hpp"
#include "skein/detail/history.hpp"

namespace skein::entity {

/// Runs of one interface's CSPs, which are named by an index, and which requests are alike.
class Experience {
 public:
  struct Run {
    std::uint32_t csp;
    std::uint64_t version;  ///< Its number among the runs of all CSPs.
    History::Sample sample;
  };
  /// What CSPs made of one request.
  struct Request {
    std::vector<Run> runs;  ///< At least one; of each CSP the last.
    Forest::Leaves leaves{};

    void add(Run run);
    std::uint64_t number() const { return runs.front().sample.request; }
    const Features& features() const { return *runs.front().sample.features; }
  };

  /// Nothing is known: all requests are alike.
  Experience() = default;
  /// Grows a forest.
  explicit Experience(std::vector<Run> runs);

  /// How many requests the forest knows.
  std::size_t size() const { return first_.size() - 1; }

  Forest::Leaves leaves(const Features& features) const;

  /// What CSPs made of similar requests, those of most common trees first; of equals the latest
  /// first. `added` are those that the forest does not know, the oldest first.
  struct Similar {
    std::span<const Run> runs;
    std::size_t trees;
  };
  std::vector<Similar> similar(const Features& features, const std::vector<Request>& added) const;

 private:
  std::vector<float> row_of(const Features& features) const;

  std::span<const Run> runs_of(std::uint32_t row) const {
    return {runs_.data() + first_[row], runs_.data() + first_[row + 1]};
  }

  std::vector<std::string> columns_;
  // Request by request as the forest's rows, the oldest first; where each begins, and the end.
  std::vector<Run> runs_;
  std::vector<std::uint32_t> first_{0};
  Forest forest_;
};

/// What the CSPs of one interface made of past requests.
class ServiceHistory {
 public:
  PastDecisions decisions;

  void add(std::string_view csp, History::Sample sample, const Prediction* predicted);
  std::vector<std::optional<Prediction>> predict(const std::vector<std::string_view>& csps,
                                                 const Features& features) const;

  /// Whether it is time to learn.
  bool is_due() const;
  std::vector<Experience::Run> runs() const;
  /// Exchanges what was learned, of the runs that there were when `version` of them had been added.
  void take(std::shared_ptr<const Experience>& learned, std::uint64_t version);
  std::uint64_t version() const { return version_; }

  /// How far the latest runs of a CSP were slower or faster than was predicted: cumulative sums.
  struct Drift {
    double slower = 0;
    double faster = 0;
    std::uint64_t slower_since = 0;  ///< The first request of these runs.
    std::uint64_t faster_since = 0;
    bool operator==(const Drift&) const = default;
  };
  struct Record {
    std::string csp;
    std::deque<History::Sample> samples;  ///< In the order in which they were added.
    Drift drift;
    bool operator==(const Record&) const = default;
  };
  const std::vector<Record>& records() const { return records_; }
  /// Takes one over as it was stored.
  void restore(Record record);

  bool operator==(const ServiceHistory& other) const {
    return decisions == other.decisions && records_ == other.records_;
  }

 private:
  std::optional<std::uint32_t> index_of(std::string_view csp) const;
  void remember(std::uint32_t csp, const History::Sample& sample);
  SimilarRun similar_run(const History::Sample& sample, double similarity) const;
  void fill_up(Prediction& prediction, std::size_t missing, const Record& record) const;

  std::vector<Record> records_;
  std::shared_ptr<const Experience> learned_ = std::make_shared<const Experience>();
  std::vector<Experience::Request> added_;  // since then
  std::uint64_t version_ = 0;               // runs added so far
  std::vector<double> reached_;             // runs by how many CSPs had failed before
  mutable bool asked_ = false;              // for predictions, since the last lesson
};

}  // namespace skein::entity

namespace skein {

/// What is to be learned from, and then what was: see History::next_lesson().
class History::Lesson {
 public:
  Lesson(std::string interface, const entity::ServiceHistory& service)
      : interface_(std::move(interface)), runs_(service.runs()), version_(service.version()) {}

  void learn() { learned_ = std::make_shared<const entity::Experience>(std::move(runs_)); }

 private:
  friend class History;
  std::string interface_;
  std::vector<entity::Experience::Run> runs_;
  std::uint64_t version_;
  std::shared_ptr<const entity::Experience> learned_;
};

}  // namespace skein

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "skein/selection.hpp"

namespace skein {

/// Orders by interface and CSP; allows look-up by views of them.
struct ByCsp {
  using is_transparent = void;
  using View = std::pair<std::string_view, std::string_view>;
  static View view(const std::pair<std::string, std::string>& key) {
    return {key.first, key.second};
  }
  static const View& view(const View& key) { return key; }
  bool operator()(const auto& left, const auto& right) const { return view(left) < view(right); }
};

namespace entity {
class ServiceHistory;
}  // namespace entity

/// What each CSP made of past requests: Rice's model (features to performance) by the most similar
/// ones. Requests are similar if they fall into the same leaves of a forest that is grown from what
/// CSPs made of them (entity::Forest), so that features count by what they tell; of equally similar
/// ones the latest are taken. The last 1000 runs of each CSP are kept; where a cumulative sum shows
/// that a CSP has become slower or faster, only those since then. Pure and deterministic: the same
/// calls give the same predictions. Not thread-safe.
class History {
 public:
  struct Sample {
    std::shared_ptr<const Features> features;  ///< Not null; requests share theirs.
    Duration took{};
    bool accepted = false;
    bool late = false;              ///< Given up: an answer would have taken longer than `took`.
    std::optional<double> quality;  ///< Of an accepted result.
    std::uint64_t request = 0;      ///< As begin() numbered it.
    std::uint32_t after = 0;        ///< How many CSPs had failed at this request before.
    bool operator==(const Sample& other) const;
  };

  static constexpr std::size_t kKept = 1000;
  static constexpr std::size_t kNeighbours = 16;
  static constexpr std::size_t kListed = 2 * kNeighbours;  ///< With those without a weight.

  History();
  History(const History& other);
  History(History&& other) noexcept;
  History& operator=(History other) noexcept;
  ~History();

  /// A request has come; the number of the first is 1.
  std::uint64_t begin(std::string_view interface);
  void note_exploration(std::string_view interface);
  PastDecisions decisions(std::string_view interface) const;

  /// `predicted` is what was predicted for this run, to be compared with it; null if nothing was.
  void add(std::string_view interface, std::string_view csp, Sample sample,
           const Prediction* predicted = nullptr);

  /// In the order of `csps`; nullopt for one that has never run.
  std::vector<std::optional<Prediction>> predict(std::string_view interface,
                                                 const std::vector<std::string_view>& csps,
                                                 const Features& features) const;

  /// What is to be learned from on another thread, so that later predictions rest on it: call its
  /// learn() there, and then take(). nullptr if too little was added since the last one, or nobody
  /// has asked for a prediction.
  class Lesson;
  std::shared_ptr<Lesson> next_lesson(std::string_view interface) const;
  void take(Lesson& lesson);
  /// Learns now, of all interfaces, however little was added.
  void learn();

  /// To JSON and back without loss. from_json() throws InvalidArgument with the place for invalid
  /// text and for another version.
  std::string to_json() const;
  static History from_json(const std::string& text);

  /// To a file and back; a file that does not exist is an empty history. Both throw InvalidArgument
  /// with the path, load() also with the place. The file is replaced as a whole: a reader gets the
  /// old or the new one.
  void save(const std::string& path) const;
  static History load(const std::string& path);

  /// Whether they hold the same runs and decisions, learned from or not.
  bool operator==(const History& other) const;

 private:
  entity::ServiceHistory& service(std::string_view interface);
  const entity::ServiceHistory* find(std::string_view interface) const;

  std::map<std::string, std::unique_ptr<entity::ServiceHistory>, std::less<>> services_;
};

}  // namespace skein

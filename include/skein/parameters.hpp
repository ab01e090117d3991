#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "skein/detail/version.hpp"

namespace skein {

/// The value of a parameter. The mission's dictionary says which of these it is: an `integer`, a
/// `real`, a `boolean`, a `duration`; a `text` or a `service` is a string. Numbers are in the
/// dictionary's unit.
using ParameterValue =
    std::variant<std::int64_t, double, bool, std::chrono::nanoseconds, std::string>;

/// Who runs a component, and changes its parameters meanwhile. For what starts components; they
/// themselves use ParameterValues::live(). Thread-safe.
class ParameterHost {
 public:
  virtual ~ParameterHost() = default;

  /// As long as what it returns lives, `change` is called with each new value, one at a time; what
  /// it throws refuses the value. The destructor of what it returns waits while it is called.
  /// Throws InvalidArgument where the parameter has such a function already.
  virtual std::shared_ptr<void> add_live(
      const std::string& name, std::function<void(const ParameterValue& value)> change) = 0;
};

/// A parameter that may be given another value while its component runs: see
/// ParameterValues::live(). Copies are the same parameter. Thread-safe.
template <class T>
class LiveParameter {
 public:
  LiveParameter(const LiveParameter&) = default;  // also in place of a move: none is empty
  LiveParameter& operator=(const LiveParameter&) = default;

  /// The latest value.
  T get() const {
    const std::lock_guard lock(state_->mutex);
    return state_->value;
  }

 private:
  friend class ParameterValues;
  struct State {
    explicit State(T value_) : value(std::move(value_)) {}
    void set(T value_) {
      const std::lock_guard lock(mutex);
      value = std::move(value_);
    }
    mutable std::mutex mutex;
    T value;
  };

  explicit LiveParameter(T value) : state_(std::make_shared<State>(std::move(value))) {}

  std::shared_ptr<State> state_;
  std::shared_ptr<void> registration_;
};

/// Values by parameter name, as a component gets them: typed, converted and checked.
class ParameterValues {
 public:
  ParameterValues() = default;
  ParameterValues(std::initializer_list<std::pair<const std::string, ParameterValue>> values)
      : values_(values) {}

  void set(const std::string& name, ParameterValue value) {
    values_.insert_or_assign(name, std::move(value));
  }
  bool contains(const std::string& name) const { return values_.contains(name); }

  /// The value, or nothing if the parameter has none. T is an integer type, double, bool, a
  /// duration of std::chrono (finer fractions are cut off), or std::string. Throws InvalidArgument
  /// for a value of another type, or one that does not fit into T; an integer is a double, too.
  template <class T>
  std::optional<T> find(const std::string& name) const;

  /// As find(), but throws InvalidArgument if the parameter has no value: for one that the
  /// component's description requires.
  template <class T>
  T get(const std::string& name) const {
    if (auto value = find<T>(name)) return *std::move(value);
    throw_missing(name);
  }

  /// As get(), for a parameter that `skein param set` may change as long as a copy of the result
  /// lives. A new value has the dictionary's type, unit and range. Before it is taken, `on_change`
  /// gets it, on a thread of the peer's, one value at a time; what it throws refuses the value, and
  /// tells why. It must return soon. The last copy's end waits for any `on_change`: let go of it
  /// outside of those, holding no lock that they take. Without a launcher the value stays as it is.
  /// Throws InvalidArgument also where the parameter is live already.
  template <class T>
  LiveParameter<T> live(const std::string& name,
                        std::function<void(const T& wanted)> on_change = {}) const;

  const std::map<std::string, ParameterValue>& all() const noexcept { return values_; }

  /// For what starts components. Copies have the same host.
  void set_host(std::shared_ptr<ParameterHost> host) { host_ = std::move(host); }

  /// By their values.
  bool operator==(const ParameterValues& other) const { return values_ == other.values_; }

 private:
  template <class T>
  static T converted(const std::string& name, const ParameterValue& value);
  const ParameterValue* find_value(const std::string& name) const;
  [[noreturn]] void throw_missing(const std::string& name) const;
  [[noreturn]] static void throw_other_type(const std::string& name, const ParameterValue& value,
                                            const char* wanted);

  std::map<std::string, ParameterValue> values_;
  std::shared_ptr<ParameterHost> host_;
};

template <class T>
std::optional<T> ParameterValues::find(const std::string& name) const {
  const ParameterValue* const value = find_value(name);
  if (!value) return std::nullopt;
  return converted<T>(name, *value);
}

template <class T>
LiveParameter<T> ParameterValues::live(const std::string& name,
                                       std::function<void(const T& wanted)> on_change) const {
  LiveParameter<T> parameter(get<T>(name));
  if (!host_) return parameter;
  parameter.registration_ =
      host_->add_live(name, [name, state = parameter.state_,
                             on_change = std::move(on_change)](const ParameterValue& value) {
        T wanted = converted<T>(name, value);
        if (on_change) on_change(wanted);
        state->set(std::move(wanted));
      });
  return parameter;
}

template <class T>
T ParameterValues::converted(const std::string& name, const ParameterValue& value) {
  if constexpr (std::is_same_v<T, bool>) {
    if (const auto* flag = std::get_if<bool>(&value)) return *flag;
    throw_other_type(name, value, "a boolean");
  } else if constexpr (std::is_integral_v<T>) {
    const auto* number = std::get_if<std::int64_t>(&value);
    if (number && std::in_range<T>(*number)) return static_cast<T>(*number);
    throw_other_type(name, value, number ? "an integer of that size" : "an integer");
  } else if constexpr (std::is_floating_point_v<T>) {
    if (const auto* number = std::get_if<double>(&value)) return static_cast<T>(*number);
    if (const auto* number = std::get_if<std::int64_t>(&value)) return static_cast<T>(*number);
    throw_other_type(name, value, "a number");
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    throw_other_type(name, value, "a text");
  } else {
    static_assert(std::is_convertible_v<std::chrono::hours, T>,
                  "a parameter is an integer, double, bool, duration of std::chrono, or string");
    if (const auto* time = std::get_if<std::chrono::nanoseconds>(&value))
      return std::chrono::duration_cast<T>(*time);
    throw_other_type(name, value, "a duration");
  }
}

/// The variable parameters that a service declares (Figure 2 of the paper), and how they get their
/// values.
class ParameterResolver {
 public:
  struct Declared {
    std::string name;
    bool required = false;
  };

  /// `service` is its name in messages.
  ParameterResolver(std::string service, std::vector<Declared> declared)
      : service_(std::move(service)), declared_(std::move(declared)) {}

  /// Takes the value of each declared parameter from the first of `sources` that has one: the
  /// caller's, the profile's, the dependencies', in this order. Optional parameters may stay unset.
  /// Throws InvalidArgument that names each required parameter without a value, or an undeclared
  /// parameter of the caller (the first source) with the nearest declared name.
  ParameterValues resolve(const std::vector<ParameterValues>& sources) const;

 private:
  void refuse_unknown(const ParameterValues& values) const;

  std::string service_;
  std::vector<Declared> declared_;
};

}  // namespace skein

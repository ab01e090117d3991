#pragma once

#include <map>
#include <string>
#include <vector>

namespace skein {

/// Values by parameter name.
using ParameterValues = std::map<std::string, std::string>;

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

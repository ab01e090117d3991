#pragma once

#include <map>
#include <string>
#include <vector>

namespace skein {

/// Values by parameter name.
using ParameterValues = std::map<std::string, std::string>;

/// The variable parameters that a service declares (the paper's Figure 2), and how the Body fills
/// them.
class ParameterResolver {
 public:
  struct Declared {
    std::string name;
    bool required = false;
  };

  /// `service` is for messages.
  ParameterResolver(std::string service, std::vector<Declared> declared)
      : service_(std::move(service)), declared_(std::move(declared)) {}

  /// The value of each declared parameter from the first of `sources` that has it: the caller's,
  /// the profile's, the dependencies', in this order. Optional ones may stay unset. Throws
  /// InvalidArgument that names each required parameter without a value, or a value that is not
  /// declared (in the first source, which is the caller's), with the nearest declared name.
  ParameterValues resolve(const std::vector<ParameterValues>& sources) const;

 private:
  void refuse_unknown(const ParameterValues& values) const;

  std::string service_;
  std::vector<Declared> declared_;
};

}  // namespace skein

#pragma once

#include <map>
#include <optional>
#include <string>

#include "mission/profile/mission_profile.hpp"
#include "mission/xml/xml_element.hpp"

namespace skein::profile {

/// The variables of a profile, and what `${name}` in its attributes stands for.
class Variables {
 public:
  /// `given`: from the command line, in place of their defaults.
  explicit Variables(const VariableValues& given) : given_(given) {}

  /// Takes a `<variable>`. Of several files the first that defines a name wins, so that a profile
  /// can give a part's variable another default before it includes the part; twice in one file is a
  /// finding.
  void define(const XmlElement& variable);

  /// Puts values in place of the names, and `$` in place of `$$`. If the attribute is one name, its
  /// `given_by` becomes the variable's place. What is wrong is a finding, and makes the attribute
  /// unreadable. `instance`: what `${instance}` stands for, if there is one.
  void expand(XmlAttribute& attribute, const std::optional<std::string>& instance,
              FindingList& findings) const;

  /// Findings, in `file`, for values from the command line that no variable takes.
  void demand_known(const std::string& file, FindingList& findings) const;

 private:
  struct Variable {
    SourcePosition where;
    SourcePosition value_where;
    std::string value;
    bool unreadable = false;
  };

  const VariableValues& given_;
  std::map<std::string, Variable, std::less<>> variables_;
};

}  // namespace skein::profile

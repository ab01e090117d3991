#include "profile_parts.hpp"

#include <algorithm>

#include "mission/xml/notation.hpp"
#include "mission/xml/text_file.hpp"
#include "mission/xml/words.hpp"

namespace skein::profile {
namespace {

constexpr int kMaxIncludes = 100;

/// Two ways to write one file are one file.
std::filesystem::path identity(const std::filesystem::path& file) {
  std::error_code ignored;
  auto path = std::filesystem::weakly_canonical(file, ignored);
  return ignored ? file.lexically_normal() : path;
}

class Parts {
 public:
  Parts(const XmlNode& mission, Variables& variables, FindingList& findings)
      : variables_(variables),
        findings_(findings),
        way_{mission.where.file},
        nodes_(size_of(mission)) {}

  /// Works on the children of a mission, a part (`holds_variables`), or an element in them.
  void put_in_place(XmlNode& node, bool holds_variables) {
    std::vector<XmlNode> children;
    for (auto& child : node.children) {
      if (child.name == "include") {
        for (auto& item : content_of(child)) children.push_back(std::move(item));
      } else if (child.name == "variable" && holds_variables) {
        demand_notation(child, *mission_notation().find_child("variable"), findings_);
        variables_.define(XmlElement(child, findings_));
      } else {
        put_in_place(child, false);
        children.push_back(std::move(child));
      }
      if (children.size() <= kMaxItems) continue;
      findings_.error(children.back().where,
                      "<" + shortened(node.name) + "> holds more than " +
                          std::to_string(kMaxItems) + " elements with its parts",
                      "make two missions of it");
      children.resize(kMaxItems);
      break;
    }
    node.children = std::move(children);
  }

  const std::set<std::filesystem::path>& files() const noexcept { return files_; }

 private:
  std::vector<XmlNode> content_of(XmlNode& include) {
    demand_notation(include, *mission_notation().find_child("include"), findings_);
    for (auto& attribute : include.attributes)
      variables_.expand(attribute, std::nullopt, findings_);
    const auto named = XmlElement(include, findings_).attribute("file");
    if (named.value.empty() || !demand_few(include)) return {};
    const auto file =
        (std::filesystem::path(named.where.file).parent_path() / named.value).lexically_normal();
    if (comes_round(file, named.where)) return {};
    way_.push_back(file);
    auto content = read(file, named);
    way_.pop_back();
    return content;
  }

  /// Parts that include parts can make much of little.
  bool demand_few(const XmlNode& include) {
    if (++includes_ <= kMaxIncludes && nodes_ <= kMaxNodes) return true;
    findings_.error(include.where, "the profile has too many parts",
                    "include at most " + std::to_string(kMaxIncludes) + ", which hold " +
                        std::to_string(kMaxNodes) + " elements and attributes at most");
    return false;
  }

  bool comes_round(const std::filesystem::path& file, const SourcePosition& where) {
    const auto same = std::find_if(way_.begin(), way_.end(), [&](const auto& before) {
      return identity(before) == identity(file);
    });
    if (same == way_.end()) return false;
    std::string round;
    for (auto step = same; step != way_.end(); ++step) round += step->string() + " -> ";
    findings_.error(where, "a circle of includes: " + round + same->string(), "remove one of them");
    return true;
  }

  std::vector<XmlNode> read(const std::filesystem::path& file, const XmlAttribute& named) {
    try {
      auto part = parse_xml(read_text_file(file), file.string(), findings_);
      files_.insert(file);
      nodes_ += size_of(part);
      if (part.name != part_notation().name) {
        findings_.error(part.where, "<" + shortened(part.name) + "> is no part of a profile",
                        "the outermost element of what is included is <part>");
        return {};
      }
      demand_notation(part, part_notation(), findings_);
      std::erase_if(part.children, [](const XmlNode& child) {
        return part_notation().find_child(child.name) == nullptr;
      });
      put_in_place(part, true);
      return std::move(part.children);
    } catch (const DescriptionError& error) {
      findings_.error(named.where, "the part " + in_quotes(named.value) + " cannot be read",
                      "the next finding says why");
      findings_.add_all(error.findings());
      return {};
    }
  }

  Variables& variables_;
  FindingList& findings_;
  std::vector<std::filesystem::path> way_;  // from the mission to the file that is being read
  std::set<std::filesystem::path> files_;
  std::size_t nodes_;
  int includes_ = 0;
};

}  // namespace

std::set<std::filesystem::path> put_parts_in_place(XmlNode& mission, Variables& variables,
                                                   FindingList& findings) {
  Parts parts(mission, variables, findings);
  parts.put_in_place(mission, true);
  return parts.files();
}

}  // namespace skein::profile

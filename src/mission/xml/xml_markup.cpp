#include "xml_markup.hpp"

#include <algorithm>
#include <vector>

#include "words.hpp"
#include "xml_text.hpp"

namespace skein::profile {
namespace {

constexpr auto kNowhere = std::string_view::npos;
constexpr std::string_view kWhiteSpace = " \t\r\n";

class MarkupScanner {
 public:
  MarkupScanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  std::optional<Finding> run() {
    while (!finding_ && (at_ = text_.find('<', at_)) != kNowhere) {
      if (starts("<!--")) {
        at_ = behind("-->");
      } else if (starts("<![CDATA[")) {
        at_ = behind("]]>");
      } else if (starts("<?")) {
        at_ = behind("?>");
      } else if (starts("<!")) {
        at_ = behind(">");
      } else if (starts("</")) {
        read_end();
      } else {
        read_start();
      }
    }
    if (!finding_ && !open_.empty()) refuse_open("the file ends first");
    return finding_;
  }

 private:
  struct Tag {
    std::string_view name;
    std::size_t place;
  };

  bool starts(std::string_view with) const { return text_.substr(at_, with.size()) == with; }

  std::size_t behind(std::string_view end) const {
    const auto found = text_.find(end, at_);
    return found == kNowhere ? text_.size() : found + end.size();
  }

  std::size_t skip_space(std::size_t from) const {
    return std::min(text_.find_first_not_of(kWhiteSpace, from), text_.size());
  }

  /// The name that begins there.
  std::string_view name_at(std::size_t from) const {
    const auto end = text_.find_first_of(" \t\r\n=/<>\"'", from);
    return text_.substr(from, std::min(end, text_.size()) - from);
  }

  void refuse(std::size_t place, const std::string& problem, const std::string& remedy) {
    finding_ = Finding{Severity::Error, position_at(text_, place, file_),
                       "malformed XML: " + problem, remedy};
  }

  std::string place_of(std::size_t place) const {
    const SourcePosition where = position_at(text_, place, file_);
    return std::to_string(where.line) + ":" + std::to_string(where.column);
  }

  void refuse_open(const std::string& what) {
    const std::string name = shortened(open_.back().name);
    refuse(open_.back().place, "<" + name + "> is not closed: " + what,
           "write </" + name + "> behind what it holds, or end the tag with />");
  }

  void read_end() {
    const std::string_view name = name_at(at_ + 2);
    if (open_.empty()) {
      return refuse(at_, "</" + shortened(name) + "> closes nothing", "remove it");
    }
    if (open_.back().name == name) {
      open_.pop_back();
      at_ = behind(">");
    } else if (std::ranges::find(open_, name, &Tag::name) != open_.end()) {
      refuse_open("</" + shortened(name) + "> comes first, at " + place_of(at_));
    } else {
      const std::string wanted = shortened(open_.back().name);
      refuse(at_,
             "</" + shortened(name) + "> closes nothing: what is open is <" + wanted + ">, at " +
                 place_of(open_.back().place),
             "write </" + wanted + ">");
    }
  }

  void read_start() {
    const Tag tag{name_at(at_ + 1), at_};
    at_ += 1 + tag.name.size();
    if (tag.name.empty()) return;  // the parser's to say
    while (!finding_) {
      at_ = skip_space(at_);
      if (at_ == text_.size() || text_[at_] == '<') {
        return refuse(tag.place, "the tag <" + shortened(tag.name) + " has no end",
                      "end it with > or />");
      }
      if (starts("/>")) {
        at_ += 2;
        return;
      }
      if (text_[at_] == '>') {
        ++at_;
        open_.push_back(tag);
        return;
      }
      if (!read_attribute()) return;
    }
  }

  /// False where it is none, or wrong.
  bool read_attribute() {
    const std::size_t place = at_;
    const std::string_view name = name_at(place);
    if (name.empty()) {
      at_ = text_.size();
      open_.clear();
      return false;  // the parser's to say
    }
    const std::string quoted = in_quotes(name);
    at_ = skip_space(place + name.size());
    if (at_ == text_.size() || text_[at_] != '=') {
      refuse(place, quoted + " has no value", "write " + shortened(name) + "=\"...\"");
      return false;
    }
    at_ = skip_space(at_ + 1);
    if (at_ == text_.size() || (text_[at_] != '"' && text_[at_] != '\'')) {
      refuse(place, "the value of " + quoted + " has no quotes",
             "write " + shortened(name) + "=\"...\"");
      return false;
    }
    const std::size_t end = text_.find(text_[at_], at_ + 1);
    const std::string_view value = text_.substr(at_ + 1, end == kNowhere ? end : end - at_ - 1);
    const bool glued = end != kNowhere && end + 1 < text_.size() &&
                       text_.find_first_of(" \t\r\n/>", end + 1) != end + 1;
    if (end == kNowhere || value.find('<') != kNowhere || (glued && value.ends_with('='))) {
      refuse(place, "the value of " + quoted + " has no closing quote",
             "end it with the quote that it begins with");
      return false;
    }
    if (glued) {
      refuse(end + 1, "a blank is missing behind the value of " + quoted, "write one");
      return false;
    }
    at_ = end + 1;
    return true;
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::vector<Tag> open_;
  std::optional<Finding> finding_;
};

}  // namespace

std::optional<Finding> find_markup_error(std::string_view text, const std::string& file) {
  return MarkupScanner(text, file).run();
}

}  // namespace skein::profile

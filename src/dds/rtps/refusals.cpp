#include "refusals.hpp"

#include <cstdio>

#include "core/log.hpp"
#include "repeated_messages.hpp"

namespace skein::dds {
namespace {

const char* describe(Refusal why) {
  switch (why) {
    case Refusal::Source:
      return "its address is not among the allowed sources";
    case Refusal::Form:
      return "it is not formed as RTPS says";
    case Refusal::Unused:
      return "nobody here uses its kind";
    case Refusal::Stranger:
      return "its participant has not announced itself";
    case Refusal::Unmatched:
      return "it is a fragment of a writer that nobody here reads";
    case Refusal::Leap:
      return "its sequence numbers are far beyond what was received of its writer";
    case Refusal::Fragment:
      return "its fragments are too small, or contradict earlier ones";
    case Refusal::Room:
      return "its sample in fragments is too large, or one too many";
    case Refusal::Parameters:
      return "its discovery parameters reach beyond it";
    case Refusal::Foreign:
      return "it speaks of another participant, or of another's endpoints";
    case Refusal::Crowd:
      return "it is of one participant too many, of its address or in all, or too soon";
    case Refusal::Announced:
      return "its participant, its address or all together have announced too many endpoints, or "
             "too large ones";
    case Refusal::Locator:
      return "its participant names only addresses that are not its own, and not in the profile "
             "(peers, allowed_sources)";
    case Refusal::Lease:
      return "it announces a participant without its lease (PID_PARTICIPANT_LEASE_DURATION)";
  }
  return "";
}

std::string to_text(std::uint32_t address) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) {
    text += (text.empty() ? "" : ".") + std::to_string(address >> shift & 0xff);
  }
  return text;
}

}  // namespace

void Refusals::count(Refusal why, unsigned char kind, std::uint32_t source) {
  const auto so_far =
      counts_[static_cast<std::size_t>(why)].fetch_add(1, std::memory_order_relaxed) + 1;
  // A peer that has just found this participant speaks to it before its own announcement arrives.
  if (why == Refusal::Stranger || !is_told(so_far)) return;
  char what[32] = "message";
  if (kind != 0) std::snprintf(what, sizeof what, "submessage (0x%02x)", kind);
  log(LogLevel::Warning, place_,
      std::string("refused a ") + what + " from " + to_text(source) + ": " + describe(why) +
          " (refused so far for this reason: " + std::to_string(so_far) + ")");
}

}  // namespace skein::dds

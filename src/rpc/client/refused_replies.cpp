#include "refused_replies.hpp"

#include "core/log.hpp"

namespace skein::rpc {

void RefusedReplies::watch(const calls::Receiver* receiver) {
  std::lock_guard lock(mutex_);
  receiver_ = receiver;
}

void RefusedReplies::note_malformed(const std::string& why) {
  std::lock_guard lock(mutex_);
  if (++malformed_ > 1) return;
  first_malformed_ = why;
  log(LogLevel::Warning, service_, "malformed reply from " + peer_ + ": " + why);
}

void RefusedReplies::note_forged(const Guid& sender) {
  std::lock_guard lock(mutex_);
  if (++forged_ > 1) return;
  log(LogLevel::Warning, service_,
      "refused a reply in the name of " + peer_ + ": participant " + sender.participant().hex() +
          ", which is not the provider, wrote it");
}

std::uint64_t RefusedReplies::malformed() const {
  std::lock_guard lock(mutex_);
  return malformed_;
}

std::uint64_t RefusedReplies::forged() const {
  std::lock_guard lock(mutex_);
  return forged_;
}

std::string RefusedReplies::what_came_malformed() const {
  std::lock_guard lock(mutex_);
  const std::uint64_t headless = receiver_ ? receiver_->malformed() : 0;
  if (malformed_ + headless == 0) return {};
  return "; " + std::to_string(malformed_ + headless) +
         " malformed replies came on this connection, the first: " +
         (malformed_ > 0 ? first_malformed_ : "no PLAIN_CDR encapsulation header") +
         ". The network damages packets, or the two sides were built from different IDL";
}

}  // namespace skein::rpc

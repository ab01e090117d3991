#include "core/system/trusted_users.hpp"

#include <unistd.h>

#include <fstream>

namespace skein {
namespace {

uid_t read_overflow_user() {
  uid_t user = 65534;  // Linux's default, if the file cannot be read
  std::ifstream("/proc/sys/kernel/overflowuid") >> user;
  return user;
}

}  // namespace

bool is_unmapped(uid_t user) {
  static const uid_t overflow = read_overflow_user();
  return user == overflow;
}

bool is_own_user(uid_t user) { return user == geteuid() && !is_unmapped(user); }

bool is_own_user_or_root(uid_t user) { return user == 0 || is_own_user(user); }

}  // namespace skein

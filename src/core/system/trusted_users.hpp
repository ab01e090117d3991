#pragma once

#include <sys/types.h>

// By these a socket's owner decides who may connect: RequestServer lets in this user and root,
// ProcessWatch this user alone, and Meeting the users of its rules.
namespace skein {

/// Whether the kernel shows every user by this number whom this process's user namespace does not
/// map: then nobody can be known by it.
bool is_unmapped(uid_t user);

/// Whether `user`, as the kernel tells of another process, is certainly this process's.
bool is_own_user(uid_t user);

/// The same, or the superuser.
bool is_own_user_or_root(uid_t user);

}  // namespace skein

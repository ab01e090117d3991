#pragma once

#include <sys/types.h>

// A socket's owner decides who may connect: mission/process/request_server.cpp lets in this user
// and root, brokerless_discovery/process_watch.cpp this user alone, and same_host/meeting.cpp the
// users of its rules. These functions tell them who is who.
namespace skein {

/// Whether the kernel shows every user by this number whom this process's user namespace does not
/// map: then nobody can be known by it.
bool is_unmapped(uid_t user);

/// Whether `user`, as the kernel tells of another process, is certainly this process's.
bool is_own_user(uid_t user);

/// The same, or the superuser.
bool is_own_user_or_root(uid_t user);

}  // namespace skein

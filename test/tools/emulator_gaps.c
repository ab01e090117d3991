// For programs that qemu runs. Version 7.2 does not know IP_MULTICAST_IF, without which Fast DDS
// opens no socket. Tests send by unicast there, so that the option makes no difference.
#include <errno.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

int setsockopt(int socket, int level, int option, const void* value, socklen_t size) {
  const int result = (int)syscall(SYS_setsockopt, socket, level, option, value, size);
  if (result != 0 && errno == ENOPROTOOPT && level == IPPROTO_IP && option == IP_MULTICAST_IF)
    return 0;
  return result;
}

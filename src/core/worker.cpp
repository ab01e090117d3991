#include "skein/core/worker.hpp"

#include <pthread.h>
#include <unistd.h>

namespace skein {

bool Worker::write_off() {
  Standing standing = Standing::Exposed;
  if (!standing_.compare_exchange_strong(standing, Standing::WrittenOff)) return false;
  replace_();
  return true;
}

void Worker::park() noexcept {
  pthread_setname_np(pthread_self(), "skein-parked");
  while (true) pause();
}

}  // namespace skein

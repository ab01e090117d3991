#include "cable.hpp"

#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace skein::test {
namespace {

constexpr std::size_t kMaxPacket = 1500;
constexpr std::chrono::milliseconds kHeldBack{5};

int open_device(const NetworkSpace& space) {
  const Inside inside(space);
  const int device = open("/dev/net/tun", O_RDWR | O_CLOEXEC | O_NONBLOCK);
  ifreq request{};
  request.ifr_flags = IFF_TUN | IFF_NO_PI;
  std::strncpy(request.ifr_name, "skein0", IFNAMSIZ - 1);
  if (device < 0 || ioctl(device, TUNSETIFF, &request) != 0) {
    std::fprintf(stderr, "skipped: TUN devices may not be made here\n");
    std::_Exit(77);
  }
  return device;
}

bool is_ipv4(const char* packet) { return (packet[0] & 0xF0) == 0x40; }

}  // namespace

Cable::Cable(const NetworkSpace& one, const NetworkSpace& other, std::uint64_t seed)
    : ends_{open_device(one), open_device(other)}, wake_(eventfd(0, EFD_CLOEXEC)), random_(seed) {
  // A test's own bursts are not to be lost here: the device's queue holds them.
  one.run("ip address add 10.77.0.1/24 dev skein0 && ip link set skein0 txqueuelen 20000 up");
  other.run("ip address add 10.77.0.2/24 dev skein0 && ip link set skein0 txqueuelen 20000 up");
  thread_ = std::thread([this] { run(); });
}

Cable::~Cable() {
  eventfd_write(wake_, 1);
  thread_.join();
  for (const int descriptor : {ends_[0], ends_[1], wake_}) close(descriptor);
}

void Cable::disturb(const Disturbance& disturbance) {
  disturb(End::One, disturbance);
  disturb(End::Other, disturbance);
}

void Cable::disturb(End from, const Disturbance& disturbance) {
  std::lock_guard lock(mutex_);
  disturbances_[static_cast<std::size_t>(from)] = disturbance;
}

Cable::Counters Cable::counters() const {
  std::lock_guard lock(mutex_);
  return counters_;
}

void Cable::run() {
  while (true) {
    timespec patience{};
    bool waits = false;
    {
      std::lock_guard lock(mutex_);
      const auto now = Clock::now();
      deliver(now);
      if (!under_way_.empty()) {
        waits = true;
        patience.tv_nsec = std::min<long>((under_way_.top().due - now).count(), 999'999'999);
      }
    }
    pollfd watched[] = {{ends_[0], POLLIN, 0}, {ends_[1], POLLIN, 0}, {wake_, POLLIN, 0}};
    ppoll(watched, 3, waits ? &patience : nullptr, nullptr);
    if (watched[2].revents != 0) return;
    receive(0);
    receive(1);
  }
}

void Cable::receive(int from) {
  char buffer[kMaxPacket];
  ssize_t size;
  while ((size = read(ends_[static_cast<std::size_t>(from)], buffer, sizeof buffer)) > 0) {
    if (!is_ipv4(buffer)) continue;  // the kernel's own greetings
    std::lock_guard lock(mutex_);
    const Disturbance& disturbance = disturbances_[static_cast<std::size_t>(from)];
    if (happens(disturbance.loss)) {
      ++counters_.lost;
      continue;
    }
    auto due = Clock::now();
    if (disturbance.jitter.count() > 0) {
      due += std::chrono::microseconds(random_() % (disturbance.jitter.count() * 1000));
    }
    if (happens(disturbance.reordering)) due += kHeldBack;
    Packet packet{due, ++last_number_, from, {buffer, buffer + size}};
    if (happens(disturbance.duplication)) {
      ++counters_.duplicated;
      under_way_.push(packet);
    }
    under_way_.push(std::move(packet));
  }
}

void Cable::deliver(Clock::time_point now) {
  while (!under_way_.empty() && under_way_.top().due <= now) {
    const Packet& packet = under_way_.top();
    const auto from = static_cast<std::size_t>(packet.from);
    // What the device does not take (it is down, say) is lost, as on any cable.
    if (write(ends_[1 - from], packet.bytes.data(), packet.bytes.size()) > 0) {
      ++counters_.carried;
      counters_.overtaken += packet.number < last_delivered_[from] ? 1 : 0;
      last_delivered_[from] = std::max(last_delivered_[from], packet.number);
    } else {
      ++counters_.lost;
    }
    under_way_.pop();
  }
}

bool Cable::happens(double share) {
  return share > 0 && std::uniform_real_distribution<>(0, 1)(random_) < share;
}

}  // namespace skein::test

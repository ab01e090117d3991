// A pilot whom boats ask whether they may leave, and who asks a buoy for the wind. Both answer
// later: ten boats wait, and neither service holds a thread meanwhile.
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <vector>

#include "harbour.idl.hpp"
#include "skein/entity.hpp"

/// Keeps all questions until it reports, and answers them then, on whatever thread that is.
class Buoy : public harbour::IBuoy::Deferred {
 public:
  void wind(skein::Reply<double> reply) override {
    std::lock_guard lock(mutex_);
    asked_.push_back(std::move(reply));
    changed_.notify_all();
  }

  void await_questions(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return asked_.size() >= count; });
  }

  void report(double wind_m_s) {
    std::vector<skein::Reply<double>> asked;
    {
      std::lock_guard lock(mutex_);
      asked.swap(asked_);
    }
    for (auto& reply : asked) reply.answer(wind_m_s);
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<skein::Reply<double>> asked_;
};

/// Calls another service for each question, and answers when that has answered.
class Pilot : public harbour::IPilot::Deferred {
 public:
  explicit Pilot(harbour::IBuoy::Proxy buoy) : buoy_(std::move(buoy)) {}

  void may_leave(double bears_m_s, skein::Reply<bool> reply) override {
    auto wind = buoy_.async_wind();  // within the limit of the call that is being served
    reply.on_cancel(wind.canceller());
    std::move(wind).then([bears_m_s, reply](skein::Call<double> wind) {
      reply.answer_with([&] { return wind.get() <= bears_m_s; });
    });
  }

 private:
  harbour::IBuoy::Proxy buoy_;
};

int main() {
  const auto vendor = skein::dds::load_vendor("loopback");
  skein::Entity sea({.name = "sea", .vendor = vendor});
  skein::Entity office({.name = "office", .vendor = vendor});
  skein::Entity quay({.name = "quay", .vendor = vendor});

  const auto buoy = std::make_shared<Buoy>();
  sea.provide<harbour::IBuoy>(buoy);
  office.provide<harbour::IPilot>(std::make_shared<Pilot>(office.connect<harbour::IBuoy>()));

  auto pilot = quay.connect<harbour::IPilot>();
  std::vector<skein::Call<bool>> boats;
  for (int bears_m_s = 5; bears_m_s < 15; ++bears_m_s)
    boats.push_back(pilot.async_may_leave(bears_m_s));

  buoy->await_questions(boats.size());
  std::printf("%zu boats wait, and each service has one thread\n", boats.size());
  buoy->report(9.5);
  int may_leave = 0;
  for (auto& boat : boats) may_leave += boat.get() ? 1 : 0;
  std::printf("%d may leave\n", may_leave);
}

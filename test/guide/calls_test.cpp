#include <catch2/catch.hpp>
#include <coroutine>
#include <cstdio>
#include <future>
#include <optional>

#include "site.hpp"
#include "skein/call_context.hpp"
#include "skein/error.hpp"
#include "skein/loaned.hpp"

using namespace std::chrono_literals;

namespace {

/// How long it takes; nothing where it must be asked again later.
std::optional<double> ask(survey::ISurveyor::Proxy& surveyor, const survey::Area& area) {
  try {
    return surveyor.minutes(area);
  } catch (const survey::TooLarge& refusal) {  // the interface's own word
    return surveyor.minutes({refusal.limit_m2 / area.width_m, area.width_m});
  } catch (const skein::Unavailable&) {  // not executed
    return std::nullopt;
  } catch (const skein::Overloaded&) {  // it was refused, and not executed
    return std::nullopt;
  } catch (const skein::Error& error) {  // all others
    std::fprintf(stderr, "%s\n", error.what());
    throw;
  }
}

/// Looks at each row by itself, and stops where nobody waits any more.
class ThoroughSurveyor : public Surveyor {
 public:
  double minutes(const survey::Area& area) override {
    double minutes = 0;
    for (double row_m = 0; row_m < area.width_m; row_m += 1) {
      if (skein::CallContext::current()->cancelled())
        throw skein::Cancelled("nobody waits any more");
      minutes += area.length_m / 5000;
    }
    return minutes;
  }
};

class Archive : public survey::IArchive {
 public:
  std::uint32_t store(const survey::Image& image) override {
    last_pixel = image.pixels.back();
    return ++stored_;
  }
  std::uint8_t last_pixel = 0;

 private:
  std::uint32_t stored_ = 0;
};

/// A coroutine that nobody waits for.
struct Job {
  struct promise_type {
    Job get_return_object() { return {}; }
    std::suspend_never initial_suspend() { return {}; }
    std::suspend_never final_suspend() noexcept { return {}; }
    void return_void() {}
    void unhandled_exception() { std::terminate(); }
  };
};

Job survey_twice(survey::ISurveyor::Proxy surveyor, std::promise<double>& total) {
  const double first = co_await surveyor.async_minutes(kField);
  const double second = co_await surveyor.async_minutes(kField);
  total.set_value(first + second);
}

/// A site whose drone has a surveyor.
struct SurveyorSite : Site {
  SurveyorSite() { drone.provide<survey::ISurveyor>(std::make_shared<Surveyor>()); }
};

}  // namespace

TEST_CASE("each call has a limit, which within() sets") {
  SurveyorSite site;
  skein::Entity& station = site.station;

  auto surveyor = station.connect<survey::ISurveyor>();  // its calls end within 5 s
  auto patient = surveyor.within(30s);                   // the same connection, another limit
  const double minutes = patient.minutes({.length_m = 400, .width_m = 300});

  CHECK(minutes == 24);
}

TEST_CASE("an implementation can see that nobody waits any more") {
  Site site;
  site.drone.provide<survey::ISurveyor>(std::make_shared<ThoroughSurveyor>());
  auto surveyor = site.station.connect<survey::ISurveyor>();
  const survey::Area endless{1, 1e300};
  CHECK_THROWS_AS(surveyor.within(100ms).minutes(endless), skein::TimedOut);
  CHECK(surveyor.within(30s).minutes({.length_m = 5000, .width_m = 3}) == 3);
}

TEST_CASE("errors say by their class what can be done next") {
  SurveyorSite site;
  auto surveyor = site.station.connect<survey::ISurveyor>();
  CHECK(ask(surveyor, kField) == 24.0);
  CHECK(ask(surveyor, {2000, 1000}) == 200.0);
  CHECK_THROWS_WITH(
      site.station.connect<survey::ISurveyor>({.system = "elsewhere", .timeout = 50ms}),
      Catch::Contains("only drone (default) offers it"));
}

TEST_CASE("a stream is read one result after the other, and dropped when enough is seen") {
  SurveyorSite site;
  auto surveyor = site.station.connect<survey::ISurveyor>();
  std::uint32_t seen = 0;
  const auto show = [&](const survey::Photo& photo) { seen = photo.number + 1; };

  for (const survey::Photo& photo : surveyor.within(1min).fly(kField)) {
    show(photo);
    if (photo.along_m >= 100) break;  // destroys the stream, which tells the provider
  }
  CHECK(seen == 11);

  auto photos = surveyor.within(1min).fly(kField);
  while (const auto photo = photos.next()) show(*photo);
  CHECK(seen == 40);
}

TEST_CASE("a large parameter can be lent") {
  Site site;
  skein::Entity& station = site.station;
  const auto shelf = std::make_shared<Archive>();
  site.drone.provide<survey::IArchive>(shelf);

  auto archive = station.connect<survey::IArchive>();
  skein::Loaned<survey::Image> image;  // once, for many calls
  image->pixels.fill(128);
  const std::uint32_t number = archive.store(*image);

  CHECK(number == 1);
  CHECK(shelf->last_pixel == 128);
}

TEST_CASE("calls can be under way at once") {
  SurveyorSite site;
  auto surveyor = site.station.connect<survey::ISurveyor>();

  auto first = surveyor.async_minutes(kField);  // returns at once
  auto second = surveyor.async_minutes(kField);
  const double total_minutes = first.get() + second.get();
  CHECK(total_minutes == 48);

  std::promise<double> done;
  surveyor.async_minutes(kField).then([&](skein::Call<double> call) {
    try {
      done.set_value(call.get());
    } catch (...) {
      done.set_exception(std::current_exception());
    }
  });
  CHECK(done.get_future().get() == 24);

  std::promise<double> total;
  survey_twice(surveyor, total);
  CHECK(total.get_future().get() == 48);
}

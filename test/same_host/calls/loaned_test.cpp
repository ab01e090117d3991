#include "skein/loaned.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cinttypes>
#include <fstream>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frames.idl.hpp"
#include "skein/error.hpp"
#include "test/connector/loopback_entity.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace std::chrono_literals;
using skein::test::eventually;
using skein::test::make_entity;
using skein::test::with_enough_time;
using ::test::Album;
using ::test::Frame;
using ::test::Line;
using ::test::Marked;

static_assert(Lendable<Frame> && Lendable<Line> && Lendable<std::uint8_t>);
static_assert(!Lendable<bool> && !Lendable<std::string> && !Lendable<Marked>);

namespace {

/// The mappings of this process whose files bear that name, as "r--s" or "rw-s" say who may what.
std::vector<std::string> mappings(const std::string& name) {
  std::vector<std::string> found;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    if (line.find(name) != std::string::npos) found.push_back(line);
  }
  return found;
}

/// How the memory there is mapped, or "" where it is not lent.
std::string lent_as(const void* address) {
  const auto at = reinterpret_cast<std::uintptr_t>(address);
  for (const std::string& line : mappings("memfd:skein-loan")) {
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
    char access[5] = {};
    if (std::sscanf(line.c_str(), "%" SCNxPTR "-%" SCNxPTR " %4s", &begin, &end, access) == 3 &&
        begin <= at && at < end) {
      return access;
    }
  }
  return "";
}

std::uint64_t weight(const Frame& frame) {
  return std::accumulate(frame.pixels.begin(), frame.pixels.end(), std::uint64_t{0});
}

/// Notes how each frame came.
class Gallery final : public Album {
 public:
  std::uint64_t weigh(const std::string& name, const Frame& frame, std::int32_t factor,
                      std::string& asked) override {
    note(&frame);
    asked = name;
    return weight(frame) * static_cast<std::uint64_t>(factor);
  }
  std::uint64_t weigh_both(const Frame& one, const Frame& other) override {
    note(&one);
    note(&other);
    return weight(one) + weight(other);
  }
  std::uint64_t weigh_line(const Line& line) override {
    note(&line);
    return std::accumulate(line.begin(), line.end(), std::uint64_t{0});
  }
  std::uint64_t study(const Frame& frame) override {
    note(&frame);
    ++inside;
    holding.wait(true);
    --inside;
    return weight(frame);
  }
  std::uint64_t weigh_marked(const Marked& marked) override {
    note(&marked);
    return std::accumulate(marked.pixels.begin(), marked.pixels.end(), std::uint64_t{0});
  }

  void let_go() {
    holding = false;
    holding.notify_all();
  }
  std::vector<std::string> came() {
    std::lock_guard lock(mutex_);
    return std::exchange(came_, {});
  }

  std::atomic<bool> holding{false};
  std::atomic<int> inside{0};

 private:
  void note(const void* value) {
    std::lock_guard lock(mutex_);
    came_.push_back(lent_as(value));
  }

  std::mutex mutex_;
  std::vector<std::string> came_;
};

/// Answers study() when told, and notes how its frames came.
class Desk final : public Album::Deferred {
 public:
  void weigh(const std::string&, const Frame&, std::int32_t,
             Reply<::test::Album_weigh_Out>) override {}
  void weigh_both(const Frame&, const Frame&, Reply<std::uint64_t>) override {}
  void weigh_line(const Line&, Reply<std::uint64_t>) override {}
  void weigh_marked(const Marked&, Reply<std::uint64_t>) override {}
  void study(const Frame& frame, Reply<std::uint64_t> reply) override {
    std::lock_guard lock(mutex_);
    asked_.emplace_back(&frame, std::move(reply));
  }

  std::size_t asked() {
    std::lock_guard lock(mutex_);
    return asked_.size();
  }
  /// The first one; how its frame came.
  std::string answer() {
    std::pair<const Frame*, Reply<std::uint64_t>> first = [&] {
      std::lock_guard lock(mutex_);
      auto taken = std::move(asked_.front());
      asked_.erase(asked_.begin());
      return taken;
    }();
    std::string came = lent_as(first.first);
    first.second.answer(weight(*first.first));
    return came;
  }

 private:
  std::mutex mutex_;
  std::vector<std::pair<const Frame*, Reply<std::uint64_t>>> asked_;
};

/// Notes how its frame came.
class Captioner final : public ::test::CaptionedAlbum {
 public:
  std::uint64_t weigh(const ::test::Caption& caption, const Frame& frame,
                      const ::test::Caption& other) override {
    came = caption.text + " " + lent_as(&frame) + " " + other.text;
    return weight(frame);
  }

  std::string came;
};

/// A service, and a client that has connected.
struct Pair {
  explicit Pair(CallThread thread = CallThread::Own, bool shared_memory = true)
      : server(make_entity("server", shared_memory)), client(make_entity("client", shared_memory)) {
    ServiceOptions options;
    options.thread = thread;
    server->provide<Album>(gallery, options);
    album.emplace(client->connect<Album>().within(60s));
  }

  const std::shared_ptr<Gallery> gallery = std::make_shared<Gallery>();
  std::unique_ptr<Entity> server;
  std::unique_ptr<Entity> client;
  std::optional<Album::Proxy> album;
};

using Came = std::vector<std::string>;

}  // namespace

TEST_CASE("a lent value is read where it lies, and cannot be written there") {
  Pair pair(GENERATE(CallThread::Own, CallThread::Caller));
  Loaned<Frame> frame;
  CHECK(weight(*frame) == 0);
  std::string asked;
  for (std::uint8_t i = 1; i <= 3; ++i) {
    frame->pixels.fill(i);
    frame->taken_at = i;
    CHECK(pair.album->weigh("number " + std::to_string(i), *frame, 2, asked) ==
          std::uint64_t{i} * frame->pixels.size() * 2);
    CHECK(asked == "number " + std::to_string(i));
  }
  CHECK(pair.gallery->came() == Came{"r--s", "r--s", "r--s"});
  CHECK(eventually([&] { return !frame.in_use(); }));
}

TEST_CASE("what is lent is copied where it cannot be read") {
  Loaned<Frame> frame;
  frame->pixels.fill(3);
  std::string asked;
  const std::uint64_t expected = 3 * frame->pixels.size();
  SECTION("over DDS") {
    Pair pair(CallThread::Own, false);
    CHECK(pair.album->weigh("", *frame, 1, asked) == expected);
    CHECK(pair.gallery->came() == Came{""});
  }
  SECTION("in the same process it is the caller's own where the service runs on his thread") {
    Pair pair(CallThread::Caller);
    auto album = pair.server->connect<Album>();
    CHECK(album.weigh("", *frame, 1, asked) == expected);
    CHECK(pair.gallery->came() == Came{"rw-s"});
  }
  SECTION("a value in the middle of it") {
    Pair pair;
    Loaned<std::array<Line, 16>> lines;
    (*lines)[3].fill(1);
    CHECK(pair.album->weigh_line((*lines)[3]) == 512);
    CHECK(pair.gallery->came() == Came{""});
  }
  SECTION("a small one") {
    Pair pair;
    Loaned<Line> line;
    line->fill(1);
    CHECK(pair.album->weigh_line(*line) == 512);
    CHECK(pair.gallery->came() == Came{""});
  }
  CHECK_FALSE(frame.in_use());
}

TEST_CASE_METHOD(Pair, "one value of a call is lent, and the others are copied") {
  Loaned<Frame> one;
  Loaned<Frame> other;
  one->pixels.fill(1);
  other->pixels.fill(2);
  const auto plain = std::make_unique<Frame>(*other);
  const std::uint64_t size = one->pixels.size();
  CHECK(album->weigh_both(*one, *other) == 3 * size);
  CHECK(gallery->came() == Came{"r--s", ""});
  CHECK(album->weigh_both(*one, *one) == 2 * size);
  CHECK(gallery->came() == Came{"r--s", ""});
  CHECK(album->weigh_both(*plain, *one) == 3 * size);
  CHECK(gallery->came() == Came{"", "r--s"});
  CHECK(album->weigh_both(*plain, *plain) == 4 * size);
  CHECK(gallery->came() == Came{"", ""});
}

TEST_CASE_METHOD(Pair, "whoever waits no longer can see that what he has lent is still read") {
  std::optional<Loaned<Frame>> frame(std::in_place);
  (*frame)->pixels.fill(5);
  gallery->holding = true;
  REQUIRE(with_enough_time(50ms, [&](std::chrono::milliseconds limit) {
    CHECK_THROWS_AS(album->within(limit).study(**frame), TimedOut);
    return gallery->inside == 1;
  }));
  CHECK(frame->in_use());
  SECTION("until the implementation returns") {
    gallery->let_go();
    CHECK(eventually([&] { return !frame->in_use(); }));
  }
  SECTION("also where the connection has ended") {
    client.reset();
    CHECK(frame->in_use());
    gallery->let_go();
    CHECK(eventually([&] { return !frame->in_use(); }));
  }
  SECTION("and it stays for the reader when it goes") {
    frame.reset();
    gallery->let_go();
    CHECK(eventually([&] { return gallery->inside == 0; }));
  }
}

TEST_CASE("what is lent to a call that is answered later is read until then") {
  const auto server = make_entity("server", true);
  const auto desk = std::make_shared<Desk>();
  server->provide<Album>(desk);
  const auto client = make_entity("client", true);
  auto album = client->connect<Album>().within(60s);
  Loaned<Frame> frame;
  frame->pixels.fill(7);
  auto first = album.async_study(*frame);
  auto second = album.async_study(*frame);
  REQUIRE(eventually([&] { return desk->asked() == 2; }));
  CHECK(desk->answer() == "r--s");
  CHECK(first.get() == 7 * frame->pixels.size());
  CHECK(frame.in_use());
  CHECK(desk->answer() == "r--s");
  CHECK(second.get() == 7 * frame->pixels.size());
  CHECK(eventually([&] { return !frame.in_use(); }));
}

TEST_CASE("a value is lent also where the call travels as XCDR2") {
  const auto server = make_entity("server", true);
  const auto captioner = std::make_shared<Captioner>();
  server->provide<::test::CaptionedAlbum>(captioner);
  const auto client = make_entity("client", true);
  auto album = client->connect<::test::CaptionedAlbum>().within(60s);
  Loaned<Frame> frame;
  frame->pixels.fill(7);
  CHECK(album.weigh({"before"}, *frame, {"after"}) == 7 * frame->pixels.size());
  CHECK(captioner->came == "before r--s after");
  const auto plain = std::make_unique<Frame>(*frame);
  CHECK(album.weigh({"before"}, *plain, {"after"}) == 7 * frame->pixels.size());
  CHECK(captioner->came == "before  after");
}

TEST_CASE_METHOD(Pair, "calls that are on their way together may lend the same value, or many") {
  std::vector<Loaned<Frame>> frames(20);
  std::vector<Call<std::uint64_t>> calls;
  for (std::size_t i = 0; i < 60; ++i) {
    auto& frame = frames[i % 20];
    if (i < 20) frame->pixels.fill(static_cast<std::uint8_t>(i + 1));
    calls.push_back(album->async_study(*frame));
  }
  // What finds all places taken is copied, which a busy provider may be too slow to take.
  const auto weighed = [&](std::size_t i) {
    try {
      return calls[i].get();
    } catch (const Overloaded&) {
      return album->study(*frames[i % 20]);
    }
  };
  for (std::size_t i = 0; i < calls.size(); ++i) {
    CHECK(weighed(i) == (i % 20 + 1) * frames[0]->pixels.size());
  }
  for (const auto& frame : frames) CHECK(eventually([&] { return !frame.in_use(); }));
}

TEST_CASE_METHOD(Pair, "a provider keeps a few memories of a client, and none that are gone") {
  for (int i = 0; i < 40; ++i) {
    Loaned<Frame> frame;
    frame->pixels.fill(1);
    CHECK(album->study(*frame) == frame->pixels.size());
  }
  CHECK(gallery->came() == Came(40, "r--s"));
  CHECK(eventually([] { return mappings("memfd:skein-loan").empty(); }));
  std::vector<Loaned<Frame>> frames(40);
  for (const auto& frame : frames) album->study(*frame);
  CHECK(gallery->came() == Came(40, "r--s"));
  CHECK(mappings("memfd:skein-loan").size() <= 40 + 8);
}

TEST_CASE("a Loaned that the system has no memory for says so") {
  CHECK_THROWS_AS(LoanMemory::make(std::size_t{1} << 62), Unavailable);
}

TEST_CASE("a Loaned that was moved from says so") {
  Loaned<Line> line;
  const auto take = [](auto& from) { return std::move(from); };
  const auto moved = take(line);
  CHECK_FALSE(moved.in_use());
  CHECK_THROWS_WITH(line.in_use(), "this loan was moved from; use the object that it was moved to");
  CHECK_THROWS_AS(*line, InvalidArgument);
}

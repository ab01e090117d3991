#include <catch2/catch.hpp>

#include "recordings.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace skein::recording;
using test::bytes_of, test::operator/;

namespace {

/// Options under which a message or two fill a chunk.
WriterOptions small_chunks() {
  WriterOptions options;
  options.chunk_size = 100;
  return options;
}

}  // namespace

TEST_CASE("what was recorded is read again: schemas, channels, messages, attachments, metadata") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.mcap";
  const Attachment attachment{"types.idl", "text/plain", "struct S {};", 5, 4};
  const Metadata metadata{"mission", {{"vehicle", "uav1"}, {"place", "Hamburg"}}};
  const std::string large(300'000, 'x');
  {
    Writer writer(path);
    const auto schema = writer.add_schema("A::S", "omgidl", "module A { struct S { long x; }; };");
    const auto first = writer.add_channel("position", schema, {{"system", "uav1"}});
    const auto second = writer.add_channel("image", 0);
    writer.attach(attachment);
    writer.add_metadata(metadata);
    CHECK(writer.write({first, 1, 10, 9, bytes_of("one")}));
    CHECK(writer.write({second, 1, 20, 19, bytes_of(large)}));
    CHECK(writer.write({first, 2, 30, 29, bytes_of("")}));
    writer.close();
    CHECK(writer.statistics().written() == 3);
    CHECK(writer.statistics().dropped() == 0);
    CHECK(writer.statistics().files == std::vector{path});
    CHECK(writer.statistics().bytes == test::content_of(path).size());
  }
  const recording::Reader reader(path);
  CHECK(reader.is_complete());
  CHECK(reader.problems().empty());
  REQUIRE(reader.schemas().size() == 1);
  CHECK(reader.schemas().begin()->second.name == "A::S");
  REQUIRE(reader.channels().size() == 2);
  CHECK(reader.channels().begin()->second ==
        recording::Channel{1, 1, "position", "cdr", {{"system", "uav1"}}});
  CHECK(reader.message_count() == 3);
  CHECK(reader.times() == std::pair<std::uint64_t, std::uint64_t>(10, 30));
  CHECK(test::all_messages(reader) == std::vector<test::KeptMessage>{{"position", 1, 10, "one"},
                                                                     {"image", 1, 20, large},
                                                                     {"position", 2, 30, ""}});
  CHECK(reader.attachments() == std::vector<std::string>{"types.idl"});
  CHECK(reader.attachment("types.idl") == attachment);
  CHECK(reader.metadata() == std::vector{metadata});
  CHECK(reader.dropped().empty());
}

TEST_CASE("messages come in the order of their log time, across chunks that overlap") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.mcap";
  const auto compression = GENERATE(std::optional<int>(), std::optional(1), std::optional(-5));
  auto options = small_chunks();
  options.compression_level = compression;
  {
    Writer writer(path, options);
    const auto channel = writer.add_channel("t", 0);
    for (std::uint32_t i = 0; i < 200; ++i) {
      const std::uint64_t time = i % 2 == 0 ? i : 400 - i;
      REQUIRE(writer.write({channel, i, time, 0, bytes_of("some text that repeats, repeats")}));
    }
  }
  const auto messages = test::all_messages(recording::Reader(path));
  CHECK(messages.size() == 200);
  CHECK(std::ranges::is_sorted(messages, {}, &test::KeptMessage::log_time));
}

TEST_CASE("messages of one time keep the order in which they were recorded") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.mcap";
  {
    Writer writer(path, small_chunks());
    const auto channel = writer.add_channel("t", 0);
    for (std::uint32_t i = 0; i < 100; ++i) {
      REQUIRE(writer.write({channel, i, 7, 0, bytes_of("x")}));
    }
  }
  const auto messages = test::all_messages(recording::Reader(path));
  REQUIRE(messages.size() == 100);
  CHECK(std::ranges::is_sorted(messages, {}, &test::KeptMessage::sequence));
}

TEST_CASE("a reader selects topics and times") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.mcap";
  {
    Writer writer(path, small_chunks());
    const auto even = writer.add_channel("even", 0);
    const auto odd = writer.add_channel("odd", 0);
    for (std::uint32_t i = 0; i < 100; ++i) {
      REQUIRE(writer.write({i % 2 == 0 ? even : odd, i, i, i, bytes_of("x")}));
    }
  }
  const recording::Reader reader(path);
  const auto found = test::all_messages(reader, {{"odd"}, 11, 15});
  CHECK(found == std::vector<test::KeptMessage>{
                     {"odd", 11, 11, "x"}, {"odd", 13, 13, "x"}, {"odd", 15, 15, "x"}});
  CHECK(test::all_messages(reader, {{"odd", "even"}, 0, 99}).size() == 100);
  CHECK_THROWS_WITH(reader.messages({{"evn"}}), Catch::Contains("has no topic 'evn'") &&
                                                    Catch::Contains("did you mean 'even'?"));
}

TEST_CASE("chunks that overlap by more than the memory are read in bounded memory, and whole") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.mcap";
  {
    WriterOptions options;
    options.chunk_size = 10'000;
    Writer writer(path, options);
    const auto channel = writer.add_channel("t", 0);
    const std::string data(9'000, 'x');
    for (std::uint32_t i = 0; i < 40; ++i) {  // each chunk lasts from 0 to 100
      REQUIRE(writer.write({channel, 2 * i, 0, 0, bytes_of(data)}));
      REQUIRE(writer.write({channel, 2 * i + 1, 100, 0, bytes_of("x")}));
    }
  }
  CHECK(test::all_messages(recording::Reader(path, {.memory = 30'000})).size() == 80);
  const recording::Reader reader(path, {.memory = 5'000});
  auto messages = reader.messages();
  CHECK_FALSE(messages.next());
  REQUIRE_FALSE(messages.problems().empty());
  CHECK_THAT(messages.problems()[0], Catch::Contains("bytes of memory, and 5000 are allowed"));
}

TEST_CASE("a recording is split by size, and no message is lost between two files") {
  const TemporaryFolder folder;
  auto options = small_chunks();
  options.split_size = 4'000;
  std::vector<std::string> files;
  {
    Writer writer(folder / "flight.mcap", options);
    const auto schema = writer.add_schema("S", "omgidl", "struct S { };");
    const auto channel = writer.add_channel("t", schema);
    writer.attach({"types.idl", "text/plain", "struct S { };", 0, 0});
    for (std::uint32_t i = 0; i < 500; ++i) {
      REQUIRE(writer.write({channel, i, i, i, bytes_of(std::to_string(i * 7919) + " text")}));
    }
    writer.close();
    files = writer.statistics().files;
  }
  REQUIRE(files.size() > 2);
  CHECK(files[0] == folder / "flight_0.mcap");
  CHECK(files[2] == folder / "flight_2.mcap");
  std::uint32_t next = 0;
  for (const std::string& file : files) {
    const recording::Reader reader(file);
    CHECK(reader.is_complete());
    CHECK(reader.schemas().size() == 1);
    CHECK(reader.channels().size() == 1);
    CHECK(reader.attachments().size() == 1);
    for (const auto& message : test::all_messages(reader)) CHECK(message.sequence == next++);
  }
  CHECK(next == 500);
}

TEST_CASE("a recording is split by time") {
  const TemporaryFolder folder;
  auto options = small_chunks();
  options.split_duration = std::chrono::nanoseconds(100);
  Writer writer(folder / "flight.mcap", options);
  const auto channel = writer.add_channel("t", 0);
  for (std::uint32_t i = 0; i < 500; ++i) {
    REQUIRE(writer.write({channel, i, i, i, bytes_of("something of some length, for a chunk")}));
  }
  writer.close();
  CHECK(writer.statistics().files.size() == 5);
  for (const std::string& file : writer.statistics().files) {
    const auto times = recording::Reader(file).times();
    REQUIRE(times);
    CHECK(times->second - times->first <= 100);
  }
}

TEST_CASE("a recording is not written over, and options that make no sense are refused") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.mcap";
  { const Writer writer(path); }
  CHECK_THROWS_WITH(Writer(path), Catch::Contains(path) && Catch::Contains("File exists") &&
                                      Catch::Contains("remove that one"));
  CHECK_THROWS_WITH(Writer(folder / "no/a.mcap"), Catch::Contains("No such file or directory"));
  WriterOptions options;
  options.compression_level = 99;
  CHECK_THROWS_WITH(Writer(folder / "b.mcap", options), Catch::Contains("zstd has no level 99"));
  options = {};
  options.chunk_size = 0;
  CHECK_THROWS_WITH(Writer(folder / "c.mcap", options), Catch::Contains("chunk_size is 0"));
}

TEST_CASE("what was not added before is refused") {
  const TemporaryFolder folder;
  Writer writer(folder / "a.mcap");
  CHECK_THROWS_WITH(writer.add_channel("t", 3), Catch::Contains("the schema 3"));
  CHECK_THROWS_WITH(writer.write({1, 0, 0, 0, {}}), Catch::Contains("the channel 1"));
  const auto channel = writer.add_channel("t", 0);
  CHECK(writer.write({channel, 0, 0, 0, {}}));
  writer.close();
  CHECK_FALSE(writer.write({channel, 0, 0, 0, {}}));
  CHECK(writer.statistics().dropped() == 1);
}

TEST_CASE("an empty recording can be read") {
  const TemporaryFolder folder;
  const std::string path = folder / "a.mcap";
  { const Writer writer(path); }
  const recording::Reader reader(path);
  CHECK(reader.is_complete());
  CHECK(reader.message_count() == 0);
  CHECK_FALSE(reader.times());
  CHECK(test::all_messages(reader).empty());
}

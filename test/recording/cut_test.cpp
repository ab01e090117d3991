#include <catch2/catch.hpp>
#include <random>

#include "recording/mcap/chunk_reader.hpp"
#include "recording/mcap/compression.hpp"
#include "recording/mcap/record_writer.hpp"
#include "recordings.hpp"
#include "skein/error.hpp"
#include "test/tools/seed.hpp"

using namespace skein;
using namespace skein::recording;
using test::bytes_of, test::operator/;

namespace {

/// A small recording with everything in it. Topics of every message are its data's beginning.
void record(const std::string& path, std::optional<int> level) {
  WriterOptions options;
  options.chunk_size = 200;
  options.compression_level = level;
  options.wait_for_room = true;
  Writer writer(path, options);
  const auto schema = writer.add_schema("A::S", "omgidl", "module A { struct S { long x; }; };");
  const std::array<std::uint16_t, 2> channels{writer.add_channel("a", schema),
                                              writer.add_channel("b", schema)};
  writer.add_metadata({"mission", {{"vehicle", "uav1"}}});
  for (std::uint32_t i = 0; i < 30; ++i) {
    const std::string data =
        std::string(i % 2 == 0 ? "a" : "b") + " and again and again " + std::to_string(i);
    writer.write({channels[i % 2], i, 100 + i, 100 + i, bytes_of(data)});
    if (i == 15) writer.attach({"file.txt", "text/plain", "content of the file", 0, 0});
  }
}

/// What a message must be.
enum class Content { AsWritten, Any };

/// Reads all there is.
std::size_t read_all(const std::string& path, Content content = Content::AsWritten) {
  const Reader reader(path, {.memory = 1 << 20});
  for (const std::string& name : reader.attachments()) {
    try {
      reader.attachment(name);
    } catch (const InvalidArgument&) {  // said to be damaged
    }
  }
  reader.dropped();
  reader.times();
  auto messages = reader.messages();
  std::size_t count = 0;
  while (const auto message = messages.next()) {
    const std::string_view data(reinterpret_cast<const char*>(message->data.data()),
                                message->data.size());
    if (content == Content::AsWritten && data.substr(1, 21) != " and again and again ") {
      FAIL("read what nobody wrote: " << data);
    }
    ++count;
  }
  return count;
}

/// Where each chunk ends, and the messages up to there.
std::map<std::uint64_t, std::size_t> messages_by_end(const std::string& path) {
  const InputFile file(path);
  const auto index = read_summary(file, 1 << 20);
  std::map<std::uint64_t, std::size_t> by_end;
  std::size_t count = 0;
  for (const ChunkPlace& place : index->chunks) {
    const Bytes records = read_chunk(file, place, 1 << 20);
    RecordReader reader(records);
    while (next_record(reader)) ++count;
    by_end[place.offset + place.length] = count;
  }
  return by_end;
}

}  // namespace

TEST_CASE("a recording that was cut at any byte opens up to its last whole chunk") {
  const TemporaryFolder folder;
  const auto level = GENERATE(std::optional<int>(), std::optional(1));
  record(folder / "whole.mcap", level);
  const std::string whole = test::content_of(folder / "whole.mcap");
  const auto by_end = messages_by_end(folder / "whole.mcap");
  REQUIRE(by_end.size() > 4);
  const std::string path = folder / "cut.mcap";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    test::put(path, std::string_view(whole).substr(0, size));
    const auto after = by_end.upper_bound(size);
    const std::size_t expected = after == by_end.begin() ? 0 : std::prev(after)->second;
    const std::size_t found = read_all(path);
    if (found != expected) {
      FAIL("cut at " << size << ": " << found << " messages, and not " << expected);
    }
    const Reader reader(path);
    if (!reader.is_complete() && reader.problems().empty()) FAIL("cut at " << size << ": not said");
    for (const auto& message : test::all_messages(reader, {{}, 0, 200})) {
      if (message.topic[0] != message.data[0]) FAIL("cut at " << size << ": a wrong topic");
    }
  }
  CHECK(read_all(folder / "whole.mcap") == 30);
}

TEST_CASE("a byte that is wrong costs at most its chunk, and reads as nothing else") {
  const TemporaryFolder folder;
  const auto level = GENERATE(std::optional<int>(), std::optional(1));
  record(folder / "whole.mcap", level);
  const std::string whole = test::content_of(folder / "whole.mcap");
  const std::string path = folder / "damaged.mcap";
  for (std::size_t at = kMagic.size(); at < whole.size(); ++at) {
    for (const unsigned char change : {0x01, 0x80, 0xFF}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      test::put(path, damaged);
      read_all(path);
    }
  }
}

TEST_CASE("damage of any kind is survived", "[fuzz]") {
  const TemporaryFolder folder;
  std::mt19937_64 dice(test::seed_of_this_run());
  const auto up_to = [&](std::size_t most) {
    return std::uniform_int_distribution<std::size_t>(0, most)(dice);
  };
  record(folder / "whole.mcap", up_to(1) == 0 ? std::optional<int>() : std::optional(1));
  const std::string whole = test::content_of(folder / "whole.mcap");
  const std::string path = folder / "damaged.mcap";
  constexpr std::array<std::uint64_t, 8> kNumbers{
      0, 1, 255, 65536, 0x7FFFFFFF, 0xFFFFFFFF, 0x7FFFFFFFFFFFFFFF, 0xFFFFFFFFFFFFFFFF};
  for (int round = 0; round < 3000; ++round) {
    std::string damaged = whole;
    for (std::size_t count = 1 + up_to(4); count > 0; --count) {
      const std::size_t at = kMagic.size() + up_to(damaged.size() - kMagic.size() - 1);
      const std::size_t size = std::min(1 + up_to(30), damaged.size() - at);
      switch (up_to(3)) {
        case 0:
          damaged.erase(at, size);
          break;
        case 1:
          damaged.insert(at, whole, up_to(whole.size() - 1), size);
          break;
        case 2:
          damaged[at] = static_cast<char>(up_to(255));
          break;
        default:
          std::memcpy(&damaged[at], &kNumbers[up_to(7)],
                      std::min<std::size_t>(8, damaged.size() - at));
      }
    }
    test::put(path, damaged);
    read_all(path, Content::Any);  // a checksum of 0 is none, and damage may have made one so
  }
}

TEST_CASE("a chunk that announces more memory than is allowed is passed over") {
  const TemporaryFolder folder;
  const std::string path = folder / "bomb.mcap";
  Bytes zeros;
  zeros.resize(50'000'000);
  std::memset(zeros.data(), 0, zeros.size());
  Bytes compressed;
  REQUIRE(Compressor(1).compress(zeros, compressed));
  const auto announced =
      GENERATE(std::uint64_t{1} << 60, std::uint64_t{50'000'000}, std::uint64_t{100});
  Bytes file{std::span<const std::byte>(kMagic)};
  RecordWriter writer(file);
  writer.record(Opcode::Header, [&] {
    writer.text("");
    writer.text("");
  });
  writer.record(Opcode::Chunk, [&] {
    writer.number(std::uint64_t{0});
    writer.number(std::uint64_t{0});
    writer.number(announced);
    writer.number(std::uint32_t{0});
    writer.text(kZstd);
    writer.number(std::uint64_t{compressed.size()});
    file.append(compressed);
  });
  test::put(path, {reinterpret_cast<const char*>(file.data()), file.size()});
  const Reader reader(path, {.memory = 1'000'000});
  REQUIRE_FALSE(reader.problems().empty());
  CHECK_THAT(reader.problems()[0],
             Catch::Contains(announced == 100 ? "cannot be decompressed to 100 bytes"
                                              : "1000000 are allowed"));
  CHECK_FALSE(reader.messages().next());
}

TEST_CASE("a small file of many chunks does not stand for a large one") {
  const TemporaryFolder folder;
  const std::string path = folder / "bomb.mcap";
  Bytes zeros, compressed;
  zeros.resize(std::size_t{60} << 20);
  std::memset(zeros.data(), 0, zeros.size());
  REQUIRE(Compressor(1).compress(zeros, compressed));
  const auto chunk = [&](RecordWriter& writer, Bytes& file) {
    writer.record(Opcode::Chunk, [&] {
      writer.number(std::uint64_t{0});
      writer.number(std::uint64_t{0});
      writer.number(std::uint64_t{zeros.size()});
      writer.number(std::uint32_t{0});
      writer.text(kZstd);
      writer.number(std::uint64_t{compressed.size()});
      file.append(compressed);
    });
  };
  Bytes file{std::span<const std::byte>(kMagic)};
  RecordWriter writer(file);
  for (int i = 0; i < 8; ++i) chunk(writer, file);
  test::put(path, {reinterpret_cast<const char*>(file.data()), file.size()});
  const Reader reader(path);
  REQUIRE(reader.problems().size() > 1);
  CHECK_THAT(reader.problems().front(),
             Catch::Contains("the chunks before it have ") && Catch::Contains("times as many"));
}

TEST_CASE("a file without chunks, as other programs write them, is read in order of time") {
  const TemporaryFolder folder;
  const std::string path = folder / "plain.mcap";
  Bytes file{std::span<const std::byte>(kMagic)};
  RecordWriter writer(file);
  writer.record(Opcode::Channel, [&] {
    writer.number(std::uint16_t{0});
    writer.number(std::uint16_t{0});
    writer.text("t");
    writer.text("json");
    writer.number(std::uint32_t{0});
  });
  for (const std::uint64_t time : {3U, 1U, 2U}) {
    writer.record(Opcode::Message, [&] {
      writer.number(std::uint16_t{0});
      writer.number(static_cast<std::uint32_t>(time));
      writer.number(time);
      writer.number(time);
      file.append(bytes_of("{}"));
    });
  }
  writer.record(Opcode::DataEnd, [&] { writer.number(std::uint32_t{0}); });
  test::put(path, {reinterpret_cast<const char*>(file.data()), file.size()});
  const Reader reader(path);
  CHECK(reader.is_complete());
  CHECK(reader.message_count() == 3);
  CHECK(test::all_messages(reader) ==
        std::vector<test::KeptMessage>{{"t", 1, 1, "{}"}, {"t", 2, 2, "{}"}, {"t", 3, 3, "{}"}});
}

TEST_CASE("what is no recording is refused, and says so") {
  const TemporaryFolder folder;
  test::put(folder / "a.txt", "some text");
  CHECK_THROWS_WITH(Reader(folder / "a.txt"), Catch::Contains("is no recording"));
  CHECK_THROWS_WITH(Reader(folder / "no.mcap"), Catch::Contains("No such file"));
  CHECK_THROWS_WITH(Reader(folder.path()), Catch::Contains("it is no file"));
}

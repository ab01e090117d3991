#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "mission/component/component_xml.hpp"
#include "profile_folder.hpp"

using namespace skein::profile;

namespace {

std::string refusal_of_file(const std::filesystem::path& file) {
  try {
    read_mission_profile(file);
  } catch (const DescriptionError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("A missing file, a directory and a special file are told apart") {
  TemporaryFolder folder;
  CHECK_THAT(refusal_of_file(folder.path() / "none.xml"),
             Catch::Contains("No such file or directory"));
  CHECK_THAT(refusal_of_file(folder.path()), Catch::Contains("is a directory"));
  CHECK_THAT(refusal_of_file("/dev/zero"), Catch::Contains("is no regular file"));
  CHECK_THAT(refusal_of_file(""), Catch::Contains("cannot be opened"));
}

TEST_CASE("Of a file that may not be read, the rights are to be checked") {
  TemporaryFolder folder;
  const auto file = folder.write("secret.xml", "<mission/>");
  REQUIRE(::chmod(file.c_str(), 0) == 0);
  const uid_t self = ::geteuid();
  constexpr uid_t kNobody = 65534;
  if (self == 0) REQUIRE(::seteuid(kNobody) == 0);  // root may read everything
  const std::string refusal = refusal_of_file(file);
  if (self == 0) REQUIRE(::seteuid(self) == 0);
  CHECK_THAT(refusal, Catch::Contains("Permission denied; check its rights, and those of its "
                                      "folders"));
}

TEST_CASE("A named pipe that nobody writes does not hang the reader") {
  TemporaryFolder folder;
  const auto pipe = folder.path() / "pipe.xml";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THAT(refusal_of_file(pipe), Catch::Contains("is no regular file"));
}

TEST_CASE("A file of any size is refused before it is read") {
  TemporaryFolder folder;
  const auto file = folder.write("large.xml", "<mission name=\"m\"/>");
  // Nobody could read a tebibyte here; the file takes no room, it is one hole.
  const auto size = GENERATE(std::uintmax_t{8 * 1024 * 1024 + 1}, std::uintmax_t{100'000'000},
                             std::uintmax_t{1} << 40);
  std::filesystem::resize_file(file, size);
  CHECK(refusal_of_file(file) == file.string() + ": error: is larger than 8 MiB");
}

TEST_CASE("An empty file is called empty") {
  TemporaryFolder folder;
  CHECK_THAT(refusal_of_file(folder.write("empty.xml", "")), Catch::Contains("is empty"));
  CHECK_THAT(refusal_of_file(folder.write("blank.xml", " \n\n")), Catch::Contains("is empty"));
}

TEST_CASE("A file full of peers is cut off, not worked through") {
  ProfileFolder folder;
  std::string peers;
  for (int i = 0; i < 100'000; ++i)
    peers += "<peer name=\"p" + std::to_string(i) + "\" component=\"n.xml\"/>";
  CHECK_THAT(folder.check(peers), Catch::Contains("<mission> holds more than 256 elements"));
}

TEST_CASE("The largest composition that is read is checked in bounded time") {
  ProfileFolder folder;
  std::string peers;
  for (int i = 0; i < 250; ++i) {
    const std::string number = std::to_string(i);
    std::string text = "<component name=\"C\"><interfaces><implements>M/I" + number +
                       "</implements></interfaces><dependencies>";
    for (int k = 0; k < 250; ++k) {
      if (k != i) text += "<depends>M/I" + std::to_string((i + k) % 250 + 1) + "</depends>";
    }
    folder.write("c" + number + ".xml", text + "</dependencies></component>");
    peers += "<peer name=\"p" + number + "\" component=\"c" + number + ".xml\"/>";
  }
  const auto text = folder.check(peers);
  CHECK_THAT(text, Catch::Contains("a cycle of dependencies") &&
                       Catch::Contains("depends on M/I250, which no peer"));
}

TEST_CASE("A component that a profile names is as mistrusted as the profile") {
  ProfileFolder folder;
  folder.write("bomb.xml", "<!DOCTYPE component [<!ENTITY a \"b\">]><component name=\"&a;\"/>");
  CHECK_THAT(folder.check("<peer name=\"a\" component=\"bomb.xml\"/>\n"
                          "<peer name=\"b\" component=\"/dev/zero\"/>\n"
                          "<peer name=\"c\" component=\".\"/>"),
             Catch::Contains("a document type with declarations") &&
                 Catch::Contains("is no regular file") && Catch::Contains("is a directory"));
}

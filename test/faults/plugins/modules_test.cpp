#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "skein/component_registry.hpp"
#include "skein/error.hpp"
#include "test/tools/child_process.hpp"
#include "test/tools/places.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein;
using namespace skein::test;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// A copy of libskein that does not know where it was built: there stand the modules.
void copy_library(const fs::path& folder) {
  const fs::path original = built_library(SKEIN_LIBRARY_SONAME);
  std::ifstream file(original, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  const std::string home = original.parent_path().string();
  for (std::size_t at = 0; (at = bytes.find(home, at)) != std::string::npos; at += home.size()) {
    bytes.replace(at, home.size(), std::string(home.size(), '_'));
  }
  std::ofstream(folder / SKEIN_LIBRARY_SONAME, std::ios::binary) << bytes;
}

/// What the peer program says when it asks for Fast DDS in that environment; it ends by itself.
std::string complaint(const std::vector<std::string>& environment) {
  ChildProcess::Options options;
  options.arguments = {"vendor=fastdds"};
  options.environment = environment;
  ChildProcess peer("faults_peer", options);
  const std::string line = peer.expect("error");
  CHECK(peer.finish() == 3);
  return line;
}

}  // namespace

TEST_CASE(
    "a vendor's module that is not there is named, with the places looked in and the remedy") {
  const TemporaryFolder folder;
  copy_library(folder.path());
  CHECK_THAT(complaint({"LD_LIBRARY_PATH=" + folder.path().string()}),
             Contains("Unavailable") && Contains("libskein_fastdds.so") &&
                 Contains(folder.path().string()) && Contains("package libfastrtps2.9") &&
                 Contains("SKEIN_MODULE_PATH"));
}

TEST_CASE("a file that is no module is named with the loader's reason") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "libskein_fastdds.so") << "no library";
  CHECK_THAT(complaint({"SKEIN_MODULE_PATH=" + folder.path().string()}),
             Contains("Unavailable") &&
                 Contains((folder.path() / "libskein_fastdds.so").string()) &&
                 Contains("cannot be loaded") && Contains("install"));
}

TEST_CASE("a module of another version is refused with both versions") {
  CHECK_THAT(
      complaint({"SKEIN_MODULE_PATH=" + built_file("test/faults/wrong_modules")}),
      Contains("Unavailable") && Contains("ABI 9999") && Contains("build both from one version"));
}

TEST_CASE(
    "a plugin that is not there, is none, or is of another version is named with the remedy") {
  ComponentRegistry registry;
  CHECK_THROWS_AS(registry.load_plugin("skein_nowhere"), Unavailable);
  CHECK_THROWS_WITH(
      registry.load_plugin("skein_nowhere"),
      Contains("libskein_nowhere.so") && Contains("install the plugin 'skein_nowhere'"));
  const std::string folder = built_file("test/faults/wrong_modules");
  CHECK_THROWS_WITH(registry.load_plugin(folder + "/libskein_wrong_plugin.so"),
                    Contains("ABI 9999") && Contains("build both from one version"));
  CHECK_THROWS_WITH(registry.load_plugin(folder + "/libskein_no_plugin.so"),
                    Contains("exports no skein_plugin_abi") && Contains("not made for Skein"));
  CHECK(registry.names().empty());
}

TEST_CASE("a plugin that throws while it registers is named with what it says") {
  ComponentRegistry registry;
  const std::string plugin = built_file("test/faults/wrong_modules/libskein_throwing_plugin.so");
  CHECK_THROWS_AS(registry.load_plugin(plugin), Unavailable);
  CHECK_THROWS_WITH(registry.load_plugin(plugin),
                    plugin + ", while it registered its components: " + "licence missing");
}

TEST_CASE("a plugin whose function is C++'s is told what is forgotten") {
  ComponentRegistry registry;
  const std::string plugin = built_file("test/faults/wrong_modules/libskein_mangled_plugin.so");
  CHECK_THROWS_AS(registry.load_plugin(plugin), InvalidArgument);
  CHECK_THROWS_WITH(registry.load_plugin(plugin),
                    Contains("exports skein_register_components as C++; write `extern \"C\"`"));
}

TEST_CASE("a plugin that is not linked with what it calls is told the function, as it is written") {
  ComponentRegistry registry;
  CHECK_THROWS_WITH(
      registry.load_plugin(built_file("test/faults/wrong_modules/libskein_unlinked_plugin.so")),
      Contains("libskein_unlinked_plugin.so cannot be loaded: it uses charts::depth_m(double, "
               "double), which is not defined; link it with the library that does"));
}

TEST_CASE("a plugin that registers nothing by any function is told the function") {
  ComponentRegistry registry;
  CHECK_THROWS_WITH(
      registry.load_plugin(built_file("test/faults/wrong_modules/libskein_bare_plugin.so")),
      Contains("exports no skein_register_components") &&
          Contains("; a plugin needs the function extern \"C\" void skein_register_components("
                   "skein::ComponentRegistry& registry)"));
}

TEST_CASE("a plugin's name that is almost right is told with the right one") {
  const std::string folder = built_file("test/faults/wrong_modules");
  const std::string file = (fs::path(folder) / "libskein_bare_plugin.so").string();
  const std::string before = [] {
    const char* set = getenv("SKEIN_MODULE_PATH");
    return std::string(set ? set : "");
  }();
  setenv("SKEIN_MODULE_PATH", (folder + ":/no/such/bulid:" + file).c_str(), 1);
  ComponentRegistry registry;
  const auto [name, answer] = GENERATE(table<std::string, std::string>({
      {"skein_bare_plugins", "no libskein_bare_plugins.so (did you mean 'skein_bare_plugin'?) in "},
      {"libskein_bare_plugin.so", " (write 'skein_bare_plugin') in "},
      {"skein_nowhere_at_all", "/no/such/bulid (of SKEIN_MODULE_PATH, and no folder), "},
      {"skein_nowhere_at_all", "libskein_bare_plugin.so (of SKEIN_MODULE_PATH, and no folder), "},
  }));
  CHECK_THROWS_AS(registry.load_plugin(name), Unavailable);
  CHECK_THROWS_WITH(registry.load_plugin(name), Contains(answer));
  const std::string without_suffix = file.substr(0, file.size() - 3);
  CHECK_THROWS_WITH(registry.load_plugin(without_suffix),
                    "there is no " + without_suffix + "; write " + file);
  setenv("SKEIN_MODULE_PATH", before.c_str(), 1);
}

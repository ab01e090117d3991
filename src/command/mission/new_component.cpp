#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "command/commands.hpp"
#include "skein/error.hpp"

namespace skein::command {

int begin_component(const NewComponentArguments& arguments) {
  const auto compiler = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "skein-idl";
  std::vector<std::string> words{compiler.string(), "--component"};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.push_back(option + value);
  };
  add("--implements=", arguments.implements);
  add("--operations=", arguments.operations);
  add("--folder=", arguments.folder);
  for (const std::string& each : arguments.needs) add("--needs=", each);
  for (const std::string& each : arguments.csps) add("--csps=", each);
  for (const std::string& each : arguments.folders) add("-I", each);
  words.insert(words.end(), {"--", arguments.kind, arguments.name});
  words.insert(words.end(), arguments.idl.begin(), arguments.idl.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  ::execv(pointers.front(), pointers.data());
  throw Unavailable(compiler.string() + " cannot be run: " + std::strerror(errno) +
                    "; install Skein's IDL compiler, package skein-idl");
}

}  // namespace skein::command

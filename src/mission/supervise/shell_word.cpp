#include "shell_word.hpp"

#include <algorithm>
#include <string_view>

namespace skein::launch {

std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./:=,+@%").find(c) != std::string_view::npos;
  });
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string shell_command(const ChildPlan& child) {
  std::string command;
  for (const auto& [name, value] : child.environment)
    command += name + "=" + shell_word(value) + " ";
  for (const auto& word : child.argv) command += shell_word(word) + " ";
  if (!command.empty()) command.pop_back();
  return command;
}

}  // namespace skein::launch

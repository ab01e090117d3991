#include "mission/supervise/mission_claim.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/log.hpp"
#include "core/system/abstract_socket.hpp"
#include "core/system/bound_sockets.hpp"
#include "core/system/trusted_users.hpp"
#include "mission/process/wake_up.hpp"
#include "skein/error.hpp"

namespace skein::launch {
namespace {

constexpr std::string_view kPrefix = "skein-launch-";

/// A launcher takes the first name that no process of another user has: anybody may take any name.
constexpr int kNames = 16;

/// With which the names of all this user's launchers begin.
std::string own_prefix() { return std::string(kPrefix) + std::to_string(::getuid()) + "-"; }

/// Two launchers of one name start the same peers. `number` is less than kNames.
std::string name_of(const profile::MissionProfile& mission, const std::string& host, int number) {
  std::set<std::string> systems;
  for (const auto& peer : mission.peers) systems.insert(peer.system);
  std::string all = mission.name + '\0' + host;
  for (const std::string& system : systems) all += '\0' + system;
  return own_prefix() + std::to_string(mission.domain) + "-" +
         std::to_string(std::hash<std::string>()(all)) +
         (number == 0 ? "" : "-" + std::to_string(number));
}

/// Not by the owner of the folder, which is root where a process has changed its user.
bool is_ours(const std::filesystem::path& process) {
  std::ifstream status(process / "status");
  std::string word;
  uid_t user = 0;
  while (status >> word && word != "Uid:") {
  }
  return status >> user && is_own_user(user);
}

/// Finds the processes of this user whose sockets have names. Strangers can take many such names,
/// so that all processes are looked at once.
class OwnHolders {
 public:
  /// A process that listens is known by the connection to it, any other by its descriptors.
  std::optional<pid_t> of(const std::string& name) {
    const Contact contact = reach(name, is_own_user);
    if (contact.reached == Reached::Yes) return contact.process;
    if (contact.reached == Reached::Stranger) return std::nullopt;
    if (!holders_) look();
    const auto found = holders_->find(name);
    return found == holders_->end() ? std::nullopt : std::optional(found->second);
  }

 private:
  void look() {
    holders_.emplace();
    std::map<std::string, std::string> names;
    for (const auto& [name, link] : bound_sockets()) {
      if (name.starts_with(own_prefix())) names.emplace(link, name);
    }
    if (names.empty()) return;
    for (const auto& each : std::filesystem::directory_iterator("/proc")) {
      const std::string number = each.path().filename();
      if (number.find_first_not_of("0123456789") != std::string::npos || !is_ours(each)) continue;
      for (const std::string& link : open_in(std::stoi(number))) {
        if (const auto found = names.find(link); found != names.end())
          holders_->emplace(found->second, std::stoi(number));
      }
    }
  }

  std::optional<std::map<std::string, pid_t>> holders_;  // by the socket's name
};

using Clock = std::chrono::steady_clock;

/// For all launchers together.
constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::milliseconds kUntilRoom{50};
constexpr std::size_t kLongestAnswer = 1 << 20;

/// What one launcher is asked.
struct Question {
  std::string name;
  pid_t launcher = 0;
  FileDescriptor socket{};  // none while too many others wait for the launcher
  std::string answer{};
  bool is_over = false;
};

void put(Question& question, const std::string& request) {
  Contact contact = reach(question.name, is_own_user);
  if (contact.reached == Reached::Unknown && errno == EAGAIN) return;
  question.is_over = contact.reached != Reached::Yes;
  if (question.is_over) return;
  question.socket = std::move(contact.socket);
  const std::string line = request + "\n";
  question.is_over = ::send(question.socket.get(), line.data(), line.size(), MSG_NOSIGNAL) !=
                     static_cast<ssize_t>(line.size());
}

void hear(Question& question) {
  std::array<char, 4096> part;
  while (!question.is_over) {
    const auto size = ::read(question.socket.get(), part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0 && errno == EAGAIN) return;
    if (size > 0) question.answer.append(part.data(), static_cast<std::size_t>(size));
    question.is_over = size <= 0 || question.answer.size() >= kLongestAnswer;
  }
}

/// Asks all at once, and hears what they answer until the time is over.
void ask(std::vector<Question>& questions, const std::string& request) {
  const auto deadline = Clock::now() + kPatience;
  while (true) {
    std::vector<pollfd> answers;
    bool have_room = true;
    for (Question& each : questions) {
      if (!each.is_over && !each.socket) put(each, request);
      if (each.is_over) continue;
      have_room = have_room && each.socket;
      answers.push_back({each.socket.get(), POLLIN, 0});  // poll() ignores -1
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (answers.empty() || left <= left.zero()) return;
    const auto wait = have_room ? left : std::min(left, kUntilRoom);
    ::poll(answers.data(), answers.size(), static_cast<int>(wait.count()));
    for (Question& each : questions) {
      if (each.socket) hear(each);
    }
  }
}

/// `; missions of this user fly here on domain 42`, where some do.
std::string flown_instead() {
  std::set<std::uint32_t> domains;
  for (const auto& [name, link] : bound_sockets()) {
    if (!name.starts_with(own_prefix())) continue;
    if (const auto domain = claimed_domain("@" + name)) domains.insert(*domain);
  }
  std::string list;
  for (const std::uint32_t domain : domains)
    list += (list.empty() ? "" : ", ") + std::to_string(domain);
  return list.empty() ? "" : "; missions of this user fly here on domain " + list;
}

/// One for each launcher of this user, or of a domain.
std::vector<Question> all_launchers(std::optional<std::uint32_t> domain = {}) {
  std::vector<Question> questions;
  OwnHolders holders;
  for (const auto& [name, link] : bound_sockets()) {
    if (!name.starts_with(own_prefix())) continue;
    if (domain && claimed_domain("@" + name) != domain) continue;
    if (const auto holder = holders.of(name)) questions.push_back({name, *holder});
  }
  return questions;
}

/// Throws as ask_launcher().
std::string checked_answer(const Question& asked) {
  const std::string& answer = asked.answer;
  if (answer.starts_with(kAccepted)) return answer.substr(kAccepted.size());
  if (answer.starts_with(kRefused))
    throw Unavailable("the launcher refuses: " + answer.substr(kRefused.size()));
  throw Unavailable("the launcher, process " + std::to_string(asked.launcher) +
                    ", does not answer; is it stopped?");
}

}  // namespace

std::string ask_launcher(const profile::MissionProfile& mission, const std::string& host,
                         const std::string& request) {
  std::vector<Question> questions;
  OwnHolders holders;
  for (int number = 0; number < kNames && questions.empty(); ++number) {
    const std::string name = name_of(mission, host, number);
    if (const auto holder = holders.of(name)) questions.push_back({name, *holder});
  }
  if (questions.empty()) {
    throw Unavailable("the mission '" + mission.name + "' is not flown here on domain " +
                      std::to_string(mission.domain) +
                      (host.empty() ? "" : " as host '" + host + "'") +
                      "; start it by skein launch, and ask as the same user" + flown_instead());
  }
  ask(questions, request);
  return checked_answer(questions.front());
}

std::string ask_launcher(pid_t launcher, const std::string& request) {
  std::vector<Question> questions = all_launchers();
  std::erase_if(questions, [&](const Question& each) { return each.launcher != launcher; });
  if (questions.empty()) {
    throw Unavailable("process " + std::to_string(launcher) +
                      " is no launcher of this user any more");
  }
  ask(questions, request);
  return checked_answer(questions.front());
}

std::vector<LauncherAnswer> ask_launchers(const std::string& request,
                                          std::optional<std::uint32_t> domain) {
  std::vector<Question> questions = all_launchers(domain);
  ask(questions, request);
  std::vector<LauncherAnswer> answers;
  for (const Question& asked : questions) {
    if (asked.is_over && !asked.socket) continue;  // it has ended meanwhile
    try {
      answers.push_back({checked_answer(asked), "", asked.launcher});
    } catch (const Unavailable& error) {
      answers.push_back({"", error.what(), asked.launcher});
    }
  }
  return answers;
}

MissionClaim::MissionClaim(const profile::MissionProfile& mission, const std::string& host) {
  ListeningSocket socket(local_socket());
  if (!socket) throw_system_error("a socket");
  const auto refuse_if_flown = [&](int number, OwnHolders& holders) {
    const auto holder = holders.of(name_of(mission, host, number));
    if (!holder) return;
    throw InvalidArgument("the mission '" + mission.name + "' is flown here already, on domain " +
                          std::to_string(mission.domain) + ", by process " +
                          std::to_string(*holder) +
                          " (skein launch); end that one first, or fly this one on another domain");
  };
  // Another user may have given back a name since a launcher of this user took a later one.
  OwnHolders holders;
  for (int number = 0; number < kNames; ++number) refuse_if_flown(number, holders);
  for (int number = 0; number < kNames; ++number) {
    name_ = name_of(mission, host, number);
    if (requests_.open(socket, name_)) return;
    if (errno != EADDRINUSE) throw_system_error("a socket with a name");
    OwnHolders now;
    refuse_if_flown(number, now);
  }
  name_.clear();
  log(LogLevel::Warning, "launch",
      "other users' processes have taken all names of the socket for requests (`ss -xlp` shows "
      "them): skein status finds nothing, and nothing keeps this mission from being flown twice");
}

std::optional<std::uint32_t> claimed_domain(std::string_view socket) {
  constexpr char kAbstract = '@';
  if (socket.empty() || socket.front() != kAbstract || !socket.substr(1).starts_with(kPrefix))
    return std::nullopt;
  socket.remove_prefix(1 + kPrefix.size());
  socket.remove_prefix(std::min(socket.find('-'), socket.size() - 1) + 1);  // the user
  std::uint32_t domain = 0;
  const auto read = std::from_chars(socket.data(), socket.data() + socket.size(), domain);
  return read.ec == std::errc() ? std::optional(domain) : std::nullopt;
}

}  // namespace skein::launch

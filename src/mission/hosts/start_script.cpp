#include "start_script.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <map>
#include <vector>

#include "core/printable.hpp"
#include "mission/process/ready.hpp"
#include "mission/supervise/child_state.hpp"
#include "mission/supervise/shell_word.hpp"

namespace skein::launch {
namespace {

/// How the script runs; the processes follow. A process NUMBER has a folder with: `says` and
/// `timer`, two FIFOs; `process` and `sleeper`, numbers of processes that run; and `ready`, `hung`,
/// `ended`, which are there or not. All that happens comes as a line through the FIFO `events`.
constexpr const char* kBeginning = R"sh(
set -u
umask 077
folder=${TMPDIR:-/tmp}/skein-script.$$
mkdir "$folder" || exit 71
mkfifo "$folder/events" "$folder/alive"

# Outlives this script by a moment, however that ends, and ends what it left.
(
  trap '' HUP INT TERM
  cat "$folder/alive" >/dev/null
  for number in "$folder"/*/process; do
    [ -f "$number" ] && kill -s KILL -- "-$(cat "$number")"
  done
  for number in "$folder"/*/sleeper; do
    [ -f "$number" ] && kill -s KILL "$(cat "$number")"
  done
  for fifo in "$folder"/*/says "$folder"/*/timer; do
    [ -p "$fifo" ] && : <>"$fifo"  # whoever waits for the other side waits no more
  done
  rm -rf "$folder"
) 2>/dev/null &
guard=$!
exec 8>"$folder/alive" 9<>"$folder/events"
trap 'echo "signal 1" >&9' HUP
trap 'echo "signal 2" >&9' INT
trap 'echo "signal 15" >&9' TERM

result=
lost=
degraded=

tell() { printf '* %s\n' "$1" >&2; }

# finish CODE WHY: the mission is over; the first cause counts.
finish() {
  [ -z "$result" ] || return 0
  result=$1
  [ "$1" -ne 0 ] || [ -z "$degraded" ] || result=75
  tell "mission: ends: $2"
}

# later SECONDS EVENT NUMBER: tells the event then, or as soon as it is cancelled.
later() {
  ( trap '' HUP TERM; read -r _ <"$folder/$3/timer"; echo "$2 $3" >&9 ) 8>&- &
  (
    ( trap '' HUP TERM; exec sleep "$1" ) 7>"$folder/$3/timer" 8>&- 9>&- &
    echo $! >"$folder/$3/sleeper"
  )
}

# cancel NUMBER
cancel() {
  [ -f "$folder/$1/sleeper" ] || return 0
  kill -s KILL "$(cat "$folder/$1/sleeper")" 2>/dev/null
  rm "$folder/$1/sleeper"
}

# signal_group SIGNAL NUMBER: the process and those that it has started.
signal_group() {
  [ -f "$folder/$2/process" ] && kill -s "$1" -- "-$(cat "$folder/$2/process" 2>/dev/null)" 2>/dev/null
}

# listen NUMBER: passes on what the process says of its readiness, and takes whatever follows.
listen() {
  trap '' HUP TERM
  while IFS= read -r said || [ -n "$said" ]; do
    case $said in
      \?*) printf 'waits %s %s\n' "$1" "${said#?}" ;;
      *) echo "ready $1"; exec cat >/dev/null ;;
    esac
  done <"$folder/$1/says" >&9
}

# run NUMBER: runs the process and tells of its end. Signals are this script's to obey.
run() {
  trap : HUP INT TERM
  "command_$1" </dev/null 3>"$folder/$1/says" 9>&- &
  echo $! >"$folder/$1/process"
  [ -e "$folder/stop" ] && signal_group INT "$1"
  wait "$!" 2>/dev/null
  code=$?
  while kill -0 "$!" 2>/dev/null; do
    wait "$!" 2>/dev/null
    code=$?
  done
  signal_group KILL "$1"
  rm -f "$folder/$1/process"
  echo "ended $1 $code" >&9
}

# judge NUMBER CODE: what its end means for the mission.
judge() {
  about "$1"
  reason=
  [ -e "$folder/$1/ready" ] || reason=$(cat "$folder/$1/reason" 2>/dev/null)
  why="$name ended with exit code $2${reason:+ (last it said: $reason)}"
  if [ -e "$folder/$1/hung" ]; then
    why="$name did not become ready${reason:+ (last it said: $reason)}"
    case $role in mission | required) finish 71 "$why" ;; esac
  elif [ "$role" = mission ]; then
    finish "$2" "$name, which runs the mission, ended with exit code $2"
  elif [ "$2" -ne 0 ] && [ "$role" = required ]; then
    if [ "$2" -eq 78 ]; then finish 78 "$why"; fi
    if [ -e "$folder/$1/ready" ]; then finish 70 "$why"; else finish 71 "$why"; fi
  elif [ "$2" -eq 0 ]; then
    return 0
  elif [ "$2" -eq 78 ] && [ "$role" = degrading ] && [ ! -e "$folder/$1/ready" ]; then
    finish 78 "$why"
  fi
  lost=${lost:-$why}
  [ -z "$result" ] || return 0
  tell "$why"
  [ "$role" = degrading ] || return 0
  degraded=yes
  tell "mission: goes on degraded, without $name"
}

# next_event: waits for the next thing that happens, and does what it asks for.
next_event() {
  read -r event number rest <&9 || return 0
  case $event in
    signal)
      [ -z "$result" ] || for file in "$folder"/*/process; do
        [ -f "$file" ] && kill -s KILL -- "-$(cat "$file")" 2>/dev/null
      done
      finish $((128 + number)) "interrupted by signal $number" ;;
    waits) printf '%s\n' "$rest" >"$folder/$number/reason" ;;
    ready)
      : >"$folder/$number/ready"
      cancel "$number" ;;
    late)
      if [ -z "$result" ] && [ ! -e "$folder/$number/ready" ] && [ ! -e "$folder/$number/ended" ]; then
        : >"$folder/$number/hung"
        rm "$folder/$number/sleeper"
        signal_group KILL "$number"
      fi ;;
    stubborn)
      if [ ! -e "$folder/$number/ended" ]; then
        about "$number"
        rm "$folder/$number/sleeper"
        later "$kill_limit" doomed "$number"
        signal_group TERM "$number"
      fi ;;
    doomed) signal_group KILL "$number" ;;
    ended)
      : >"$folder/$number/ended"
      cancel "$number"
      judge "$number" "$rest" ;;
  esac
}

# have_begun NUMBER..., have_ended NUMBER...: whether each of them is ready or ended; ended, or never started.
have_begun() {
  for asked; do
    [ -e "$folder/$asked/ready" ] || [ -e "$folder/$asked/ended" ] || return 1
  done
}
have_ended() {
  for asked; do
    [ -e "$folder/$asked/ended" ] || [ ! -d "$folder/$asked" ] || return 1
  done
}

# start NUMBER...: these at once, and waits until all of them are ready.
start() {
  [ -z "$result" ] || return 0
  for each; do
    about "$each"
    mkdir "$folder/$each"
    mkfifo "$folder/$each/says" "$folder/$each/timer"
    (exec 8>&-; listen "$each") &
    later "$start_limit" late "$each"
    (exec 8>&-; run "$each") &
    [ "$tells_ready" = yes ] || echo "ready $each" >&9
  done
  until [ -n "$result" ] || have_begun "$@"; do next_event; done
}

# fly NUMBER...: until the mission is over.
fly() {
  until [ -n "$result" ]; do
    if ! have_ended "$@"; then
      next_event
    elif [ -n "$lost" ]; then
      finish 70 "$lost"
    else
      finish 0 "all processes have ended"
    fi
  done
  : >"$folder/stop"
}

# stop NUMBER...: these at once, and waits until none of them is left.
stop() {
  for each; do
    if have_ended "$each"; then continue; fi
    about "$each"
    cancel "$each"
    later "$terminate_limit" stubborn "$each"
    signal_group INT "$each"
  done
  until have_ended "$@"; do next_event; done
}
)sh";

constexpr const char* kEndOfScript = R"sh(
trap '' HUP INT TERM
exec 8>&-
wait "$guard"
exit "$result"
)sh";

/// `1.333`, for sleep(1).
std::string shell_seconds(std::chrono::nanoseconds time) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3f", std::chrono::duration<double>(time).count());
  return text.data();
}

std::string role_of(const ChildPlan& child) {
  if (child.runs_mission) return "mission";
  switch (child.rules.on_loss) {
    case profile::LossPolicy::Abort:
      return "required";
    case profile::LossPolicy::Degrade:
      return "degrading";
    case profile::LossPolicy::Continue:
      break;
  }
  return "optional";
}

/// The numbers of the processes that start together, in the order of the start, as words.
std::vector<std::string> layers_of(const LaunchPlan& plan) {
  std::map<std::size_t, std::string> layers;
  for (std::size_t i = 0; i < plan.children.size(); ++i)
    layers[plan.children[i].layer] += " " + std::to_string(i + 1);
  std::vector<std::string> words;
  for (auto& [layer, numbers] : layers) words.push_back(std::move(numbers));
  return words;
}

}  // namespace

std::string start_script(const LaunchPlan& plan) {
  std::string text =
      "#!/bin/sh\n# shellcheck disable=SC2016,SC2317  # commands may hold any text; they are "
      "called "
      "by number\n# Runs the mission '" +
      printable(plan.mission) +
      "' as `skein launch` does, but that it starts no process a second time: a process that\n"
      "# the mission needs and that fails ends it. Nor does it watch whether processes make "
      "progress.\n# Written by `skein script`.\n";
  for (const std::string& name : plan.elsewhere) text += "# Not started here: " + name + "\n";
  text += kBeginning;
  text += "\n# about NUMBER\nabout() {\n  case $1 in\n";
  for (std::size_t i = 0; i < plan.children.size(); ++i) {
    const ChildPlan& child = plan.children[i];
    const auto terminate = time_to_terminate(child.rules.stop_timeout);
    text += "    " + std::to_string(i + 1) + ") name=" + shell_word(child.name) +
            " role=" + role_of(child) + " start_limit=" + shell_seconds(child.rules.ready_timeout) +
            " terminate_limit=" + shell_seconds(terminate) +
            " kill_limit=" + shell_seconds(child.rules.stop_timeout - terminate) +
            " tells_ready=" + (child.tells_ready ? "yes" : "no") + " ;;\n";
  }
  text += "  esac\n}\n";
  for (std::size_t i = 0; i < plan.children.size(); ++i) {
    text += "\ncommand_" + std::to_string(i + 1) +
            "() {\n  exec setsid env --default-signal=INT,QUIT " + kReadyVariable + "=3 " +
            shell_command(plan.children[i]) + "\n}\n";
  }
  const auto layers = layers_of(plan);
  std::string all;
  text += "\n";
  for (const std::string& numbers : layers) {
    text += "start" + numbers + "\n";
    all += numbers;
  }
  text += "fly" + all + "\n";
  std::for_each(layers.rbegin(), layers.rend(),
                [&](const std::string& numbers) { text += "stop" + numbers + "\n"; });
  return text + kEndOfScript;
}

}  // namespace skein::launch

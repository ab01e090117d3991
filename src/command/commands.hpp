#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "command/look/onlooker.hpp"

/// The subcommands of `skein`: what the command line (the folder `line`) tells each, and the
/// function that runs it. It returns the exit code; line/main.cpp has one for each exception.
namespace skein::command {

struct BenchArguments {
  std::string vendor = "cyclonedds";
  std::uint32_t domain = 99;
  std::string interface;  ///< Empty: loopback.
  std::string peer;       ///< The other host's address, if they speak on an interface.
  std::string profile;    ///< A mission profile: vendor, interface and threads are its peers'.
  std::string provider;   ///< Its peer that is called; empty: its first.
  std::string caller;     ///< Its peer that calls; empty: the provider.
  std::string transport;  ///< `dds` or `shared-memory`; empty: what peers of this kind take.
  std::vector<std::size_t> payloads{64, 1024, 65'536, 1'048'576};
  std::size_t count = 1000;
  std::size_t in_flight = 64;
  bool serve = false;   ///< Be the other side, until ended.
  bool remote = false;  ///< The other side runs already, elsewhere.
  std::string output;
};

/// `skein bench latency|throughput|discovery`: the cost of calls here.
int bench_latency(const BenchArguments& arguments);
int bench_throughput(const BenchArguments& arguments);
int bench_discovery(const BenchArguments& arguments);

struct BenchCompareArguments {
  std::string before;
  std::string after;
};

/// `skein bench compare A B`: prints the rows that two saved results share, with the quotient of
/// their medians. Throws InvalidArgument if a file holds no result, or if they share none.
int bench_compare(const BenchCompareArguments& arguments);

struct CallsArguments : Onlooker {
  std::string entity;  ///< NAME or SYSTEM/NAME; empty: all.
  double seconds = 0;  ///< 0: until interrupted.
  bool json = false;
};

/// `skein calls`: what happens to each call on a domain, live.
int show_calls(const CallsArguments& arguments);

struct LogArguments : Onlooker {
  std::string entity;           ///< NAME or SYSTEM/NAME; empty: all.
  std::string level = "debug";  ///< The least that is shown.
  double seconds = 0;           ///< 0: until interrupted.
  bool json = false;
};

/// `skein log`: what the entities of a domain log, the latest lines first.
int show_log(const LogArguments& arguments);

struct MissionArguments {
  std::string profile;
  std::vector<std::string> settings;
  std::vector<std::string> variables;
};

struct DecisionsArguments : Onlooker {
  std::string entity;  ///< NAME or SYSTEM/NAME; empty: all.
  double seconds = 0;  ///< 0: until interrupted.
  std::string log;     ///< Empty: live.
  bool replays = false;
  bool json = false;
  std::vector<std::string> plugins;
};

/// `skein decisions`: how the Heads on a domain decide, live or from a log. 1 if a replay comes
/// out differently.
int show_decisions(const DecisionsArguments& arguments);

struct DoctorArguments {
  std::string profile;  ///< Empty: this machine alone.
  std::string host;
  std::optional<std::uint32_t> domain;  ///< Nothing: the profile's, or the environment's.
  std::string interface;                ///< Empty: the profile's, or loopback.
  std::vector<std::string> variables;
  bool json = false;
};

/// `skein doctor [PROFILE]`: what on this machine keeps peers from speaking to each other. 0 where
/// nothing does, 1 with warnings, 2 with errors.
int examine(const DoctorArguments& arguments);

struct PlanArguments : MissionArguments {
  std::string host;
  std::vector<std::string> only;  ///< Peers and groups; empty for all.
};

struct CheckArguments : PlanArguments {
  std::string text;  ///< A file with what the profile will hold; empty: what it holds.
  bool json = false;
};

/// `skein check PROFILE`: everything that is wrong with a mission profile, for people on stderr or
/// as JSON on stdout.
int check(const CheckArguments& arguments);

struct NewComponentArguments {
  std::string kind;  ///< `entity`, `csp` or `activity`.
  std::string name;
  std::string implements;  ///< An interface; empty: a new one.
  std::string operations;  ///< Those of the new interface, in IDL; empty: an example.
  std::vector<std::string> needs;
  std::vector<std::string> csps;
  std::vector<std::string> idl;      ///< Files with the interfaces.
  std::vector<std::string> folders;  ///< In which IDL files are looked for.
  std::string folder;  ///< In which the component gets its own; empty: the present one.
};

/// `skein new KIND NAME`: source, description and project of a new component. Becomes `skein-idl`,
/// whose exit code is this process's. Throws Unavailable if that is not there.
int begin_component(const NewComponentArguments& arguments);

struct LaunchArguments : PlanArguments {
  bool dry_run = false;
  bool verbose = false;
  bool ssh = false;        ///< Starts the peers of other hosts, too.
  bool attended = false;   ///< By another launcher, on stdin and stdout.
  std::string log_folder;  ///< Empty: the profile's, or that of launch::log_folder().
  bool no_log = false;
  std::size_t log_size = 10;  ///< MiB of one file.
  std::size_t log_files = 5;  ///< For each process.
};

/// `skein launch PROFILE`: each peer in a process of its own.
int launch(const LaunchArguments& arguments);

struct AttendArguments : PlanArguments {
  bool verbose = false;
};

/// `skein attend PROFILE --host HOST`: that host's part of a mission, started over ssh by `launch
/// --ssh`.
int attend(const AttendArguments& arguments);

struct PeerArguments : MissionArguments {
  std::string process;
  std::vector<std::string> words;  ///< For its components.
};

/// `skein peer PROFILE PROCESS`: one process of a mission, as `launch` starts it.
int run_peer(const PeerArguments& arguments);

struct ScriptArguments : PlanArguments {
  std::string output;  ///< The script's file; empty: stdout.
};

/// `skein script PROFILE`: the mission as a shell script.
int write_script(const ScriptArguments& arguments);

struct GraphArguments : Onlooker {
  double seconds = 1.5;
  std::string format = "dot";
  bool json = false;   ///< As the format json.
  bool tools = false;  ///< Skein's commands, too.
};

/// `skein graph`: who speaks to whom on a domain, for Graphviz, Mermaid or programs.
int draw_graph(const GraphArguments& arguments);

struct PeersArguments : Onlooker {
  double seconds = 1.5;
  bool json = false;
};

/// `skein peers`: the peers on a domain now.
int list_peers(const PeersArguments& arguments);

struct RunningArguments {
  std::string profile;
  std::vector<std::string> variables;
  std::string host;
};

struct RestartArguments : RunningArguments {
  std::string process;
};

/// `skein restart PROFILE PROCESS`: the launcher of a mission starts one of its processes anew.
int restart_process(const RestartArguments& arguments);

struct StatusArguments : RunningArguments {
  bool json = false;
};

/// `skein status [PROFILE]`: what the launcher of a mission knows of its processes; without a
/// profile, of all missions that this user flies here.
int show_status(const StatusArguments& arguments);

struct ServicesArguments : Onlooker {
  double seconds = 1.5;
  bool statistics = false;
  bool json = false;
};

/// `skein services`: the services on a domain now.
int list_services(const ServicesArguments& arguments);

struct CallArguments : Onlooker {
  std::string name;
  std::string operation;
  std::string values;    ///< JSON; `-`: standard input.
  std::string system;    ///< Empty: any.
  double within = 5;     ///< Seconds.
  bool example = false;  ///< Print arguments, and call nothing.
  double seconds = 5;
  bool json = false;
};

/// `skein call`: an operation of a service, by its description alone; or an example of its
/// arguments. 1 if it ends with an exception that its interface declares.
int call(const CallArguments& arguments);

struct ParamArguments : Onlooker {
  std::string entity;  ///< NAME or SYSTEM/NAME; `list`: empty for all.
  std::string parameter;
  std::string value;
  double within = 5;   ///< Seconds, for one entity's answer.
  double seconds = 5;  ///< Until the entity is there; `list` of all: how long it listens.
  bool json = false;
};

/// `skein param list|get|set`: parameters of peers that run. `set` returns 1 if the component
/// refuses the value; `list` of all kNoAnswer if one did not answer.
int list_parameters(const ParamArguments& arguments);
int get_parameter(const ParamArguments& arguments);
int set_parameter(const ParamArguments& arguments);

struct LiveNamesArguments : Onlooker {
  std::string kind;    ///< `service`, `operation`, `topic`, `entity`, `parameter` or `name`.
  std::string before;  ///< The argument before it on the command line: of which service.
};

/// Of `skein complete`: names of that kind on a domain, for the completion of shells.
int print_live_names(const LiveNamesArguments& arguments);

struct DescribeArguments : Onlooker {
  std::string name;
  double seconds = 1.5;
  bool json = false;
};

/// `skein describe`: the IDL of a service or a topic, as its provider or publisher tells it.
int describe(const DescribeArguments& arguments);

struct TopicsArguments : Onlooker {
  double seconds = 1.5;
  bool names = false;  ///< Nothing else of each.
  bool json = false;
};

/// `skein topics`: who publishes and subscribes to what.
int list_topics(const TopicsArguments& arguments);

struct TopicArguments : Onlooker {
  std::string topic;
  std::string file;    ///< echo: a recording, in place of the domain.
  double wait = 5;     ///< Until the topic is there.
  double seconds = 0;  ///< 0: until interrupted.
  std::uint64_t count = 0;
  bool json = false;
};

/// `skein echo TOPIC`: its values as they come. 1 if fewer come than it is to end after.
int echo(const TopicArguments& arguments);

/// `skein rate TOPIC`: how often values come, how evenly, and how large they are.
int show_rate(const TopicArguments& arguments);

struct PublishArguments : TopicArguments {
  std::string value;  ///< JSON; `-`: standard input, one value a line.
  double rate = 0;    ///< Values a second; 0: one alone.
};

/// `skein publish TOPIC VALUE`. Throws Interrupted if a signal comes before all is published.
int publish(const PublishArguments& arguments);

struct TopArguments : Onlooker {
  double every = 1;  ///< Seconds.
  bool once = false;
  bool json = false;
  bool tools = false;  ///< Skein's commands, too.
};

/// `skein top`: peers, services and decisions of a domain, on a whole screen.
int show_top(const TopArguments& arguments);

struct ViewArguments : Onlooker {
  std::uint16_t port = 8765;
  std::string token;  ///< Empty: a random one.
  std::vector<std::string> origins;
  bool calls = false;  ///< Clients may call services.
};

/// `skein view`: shows a domain to Lichtblick and Foxglove, until interrupted.
int serve_view(const ViewArguments& arguments);

struct DesignerArguments : Onlooker {
  std::string composed;                 ///< A profile, to compose it.
  std::vector<std::string> components;  ///< Folders.
  bool watch = false;
  std::string replay;  ///< A recording, in place of the domain.
  std::uint16_t port = 8080;
  std::string token;  ///< Empty: a random one.
  bool faults = false;
  bool no_browser = false;
};

/// `skein designer`: a page on which a mission is composed, or that shows a domain while missions
/// fly there, or a recording, until interrupted.
int serve_designer(const DesignerArguments& arguments);

struct RecordArguments : Onlooker {
  std::string output;  ///< Empty: a name with the time.
  std::vector<std::string> topics;
  double seconds = 0;  ///< 0: until interrupted.
  std::uint64_t split_megabytes = 0;
  bool only_topics = false;
  bool json = false;
};

/// `skein record`: topics, calls and decisions of a mission, in a file.
int record(const RecordArguments& arguments);

struct ReplayArguments : Onlooker {
  std::string file;
  std::vector<std::string> topics;
  double rate = 1;
  bool decisions = false;
  bool json = false;
  std::vector<std::string> plugins;
};

/// `skein replay FILE`: publishes a recording's topics again, or makes its decisions again. Throws
/// Interrupted as publish().
int replay_recording(const ReplayArguments& arguments);

struct InfoArguments {
  std::string file;
  bool json = false;
};

/// `skein info FILE`: what a recording has. 1 if it holds no messages.
int show_recording(const InfoArguments& arguments);

/// One of the three outputs is named.
struct ExportArguments {
  std::string file;
  std::string csv;       ///< A folder.
  std::string lines;     ///< A file.
  std::string perfetto;  ///< A file.
  std::vector<std::string> topics;
  bool json = false;
};

/// `skein export FILE`: a recording for other programs.
int export_recording(const ExportArguments& arguments);

}  // namespace skein::command

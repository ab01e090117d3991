#include "command/commands.hpp"
#include "command_line.hpp"

// Services and topics that are known by their description alone.
namespace skein::command {

Subcommands topic_commands;

namespace {

void add_call(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "call",
      "Call an operation of a running service, with JSON\n\n"
      "The service tells its types itself; no IDL is needed. ARGUMENTS is a JSON object of the "
      "parameters by name. Of an operation with one parameter, its value alone will do. What the "
      "operation returns is printed; of a stream, each result as it comes.",
      {{"skein call IGreeter greet '\"world\"' --domain 7", "One parameter: its value"},
       {"skein call navigator plan '{\"problem\": ...}' --within 500ms", "By the entity's name"},
       {"skein call IGreeter greet --example > name.json", "A template of the arguments"},
       {"skein call IGreeter greet - < name.json", "Arguments from a file"}});
  auto& arguments = arguments_of(command, call, result);
  command.add_option("SERVICE", arguments.name, "An interface, or an entity: NAME or SYSTEM/NAME")
      ->type_name(kService)
      ->required();
  command.add_option("OPERATION", arguments.operation, "What to call")
      ->type_name(kOperation)
      ->required();
  auto* values =
      command
          .add_option("ARGUMENTS", arguments.values, "JSON, or - for standard input; default: none")
          ->type_name("JSON");
  command
      .add_flag("--example", arguments.example,
                "Call nothing: print arguments to fill in, which it takes as they stand")
      ->excludes(values);
  add_onlooker(command, arguments);
  command
      .add_option("--system", arguments.system,
                  "The vehicle or station of the provider; default: any")
      ->type_name("NAME");
  add_duration(command, "--within", arguments.within, "Timeout of the call", Zero::Refused)
      ->default_str(default_duration(arguments.within));
  add_duration(command, "--wait", arguments.seconds, "How long to look for a provider", Zero::Taken)
      ->default_str(default_duration(arguments.seconds));
  add_json(command, arguments.json);
  add_exit_codes(command);
}
const SubcommandRow kCallRow(topic_commands, add_call);

void add_describe(CLI::App& app, int& result) {
  auto& command =
      add_command(app, "describe", "Print the IDL of a running service or of a topic",
                  {{"skein describe INavigator --domain 42", "An interface and all its types"},
                   {"skein describe pose --domain 42", "The type of a topic"}});
  auto& arguments = arguments_of(command, describe, result);
  command.add_option("NAME", arguments.name, "An interface, an entity, a topic or its type")
      ->type_name(kServiceOrTopic)
      ->required();
  add_onlooker(command, arguments);
  add_wait(command, arguments.seconds);
  add_json(command, arguments.json);
  add_exit_codes(command);
}
const SubcommandRow kDescribeRow(topic_commands, add_describe);

void add_topic(CLI::App& command, TopicArguments& arguments) {
  command.add_option("TOPIC", arguments.topic, "Its name")->type_name(kTopic)->required();
  add_onlooker(command, arguments);
  add_duration(command, "--wait", arguments.wait, "How long to look for the topic", Zero::Taken)
      ->default_str(default_duration(arguments.wait));
}

void add_topic_watching(CLI::App& command, TopicArguments& arguments, const char* what) {
  add_duration(command, "--for", arguments.seconds, "How long to watch; default: until interrupted",
               Zero::Refused);
  command.add_option("--count", arguments.count, what)->type_name("NUMBER")->check(above_zero());
  add_json(command, arguments.json);
}

void add_echo(CLI::App& app, int& result) {
  auto& command = add_command(app, "echo",
                              "Print the values of a topic as they come\n\n"
                              "Exit code 1: fewer values came than --count says.",
                              {{"skein echo pose --domain 42", "JSON, until Ctrl-C"},
                               {"skein echo pose --count 1 --json", "One value, in one line"},
                               {"skein echo pose --file flight.mcap", "What was recorded"}});
  auto& arguments = arguments_of(command, echo, result);
  add_topic(command, arguments);
  command
      .add_option("--file", arguments.file,
                  "A recording whose values are printed; default: look at the domain")
      ->type_name(kFile);
  add_topic_watching(command, arguments, "End after so many values; default: no limit");
  add_exit_codes(command);
}
const SubcommandRow kEchoRow(topic_commands, add_echo);

void add_param_options(CLI::App& command, ParamArguments& arguments) {
  add_onlooker(command, arguments);
  add_duration(command, "--within", arguments.within, "Timeout of the question", Zero::Refused)
      ->default_str(default_duration(arguments.within));
  add_duration(command, "--wait", arguments.seconds, "How long to look for the entity", Zero::Taken)
      ->default_str(default_duration(arguments.seconds));
  add_json(command, arguments.json);
  add_exit_codes(command);
}

ParamArguments& add_parameter(CLI::App& command, int (*function)(const ParamArguments&),
                              int& result) {
  auto& arguments = arguments_of(command, function, result);
  command
      .add_option("ENTITY", arguments.entity, "SYSTEM/NAME; or NAME, where one system alone has it")
      ->type_name(kEntity)
      ->required();
  command
      .add_option("PARAMETER", arguments.parameter,
                  "Its name; of a CSP in its owner's process: CSP.NAME")
      ->type_name(kParameter)
      ->required();
  return arguments;
}

void add_param(CLI::App& app, int& result) {
  auto& param = add_command(
      app, "param",
      "Read and set parameters of peers while they run\n\n"
      "Of peers with a component that declares a parameter which may change while it runs. A value "
      "is written as in a mission profile, with its unit, and checked as there; the component may "
      "refuse it. A peer that starts anew has its profile's values again.",
      {{"skein param list --domain 42", "All parameters, and which may change"},
       {"skein param set beacon Period '200 ms'", "Another value, from now on"}});
  param.require_subcommand(1);

  auto& list = add_command(param, "list", "List the parameters of running peers",
                           {{"skein param list --domain 42", "Of all peers that tell them"},
                            {"skein param list beacon --json", "Of one, for programs"}});
  auto& listed = arguments_of(list, list_parameters, result);
  listed.seconds = 1.5;
  list.add_option("ENTITY", listed.entity, "SYSTEM/NAME or NAME; default: all")->type_name(kEntity);
  add_param_options(list, listed);

  auto& get = add_command(param, "get", "Print a parameter of a running peer",
                          {{"skein param get beacon Period --domain 42", "Its value now"}});
  add_param_options(get, add_parameter(get, get_parameter, result));

  auto& set = add_command(param, "set", "Give a parameter of a running peer another value",
                          {{"skein param set beacon Period '200 ms' --domain 42",
                            "Exit code 1: the component refuses it, and says why"}});
  auto& changed = add_parameter(set, set_parameter, result);
  set.add_option("VALUE", changed.value, "As a mission profile has it, with its unit")
      ->type_name("VALUE")
      ->required();
  add_param_options(set, changed);
}
const SubcommandRow kParamRow(topic_commands, add_param);

void add_publish(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "publish",
      "Publish values on a topic that an entity has, with JSON\n\n"
      "Where it is interrupted before all is published, it says how much was, and its exit code is "
      "128 + N for signal N; with --rate alone, Ctrl-C is the end that is meant.",
      {{"skein publish target '{\"x\": 1, \"y\": 2}' --domain 42", "Once"},
       {"skein publish target '{\"x\": 1, \"y\": 2}' --rate 10", "Ten a second, until Ctrl-C"}});
  auto& arguments = arguments_of(command, publish, result);
  add_topic(command, arguments);
  command.add_option("VALUE", arguments.value, "JSON, or - for standard input, one value a line")
      ->type_name("JSON")
      ->required();
  command.add_option("--rate", arguments.rate, "Values a second; default: one value alone")
      ->check(above_zero())
      ->type_name("NUMBER");
  command.add_option("--count", arguments.count, "End after so many values; default: no limit")
      ->type_name("NUMBER")
      ->check(above_zero());
  add_json(command, arguments.json, "what was published");
  add_exit_codes(command);
}
const SubcommandRow kPublishRow(topic_commands, add_publish);

void add_rate(CLI::App& app, int& result) {
  auto& command = add_command(
      app, "rate", "Measure how often values of a topic come, how evenly, how large they are",
      {{"skein rate pose --domain 42", "A line a second, until Ctrl-C"}});
  auto& arguments = arguments_of(command, show_rate, result);
  add_topic(command, arguments);
  add_topic_watching(command, arguments, "End after so many lines; default: no limit");
  add_exit_codes(command);
}
const SubcommandRow kRateRow(topic_commands, add_rate);

void add_topics(CLI::App& app, int& result) {
  auto& command = add_command(app, "topics", "List who publishes and subscribes to what",
                              {{"skein topics --domain 42", "Types, entities, QoS and counts"},
                               {"skein topics --names", "A line for each topic"}});
  auto& arguments = arguments_of(command, list_topics, result);
  add_onlooker(command, arguments);
  add_wait(command, arguments.seconds);
  auto* names = command.add_flag("--names", arguments.names, "Print the topics' names alone");
  add_json(command, arguments.json)->excludes(names);
  add_exit_codes(command);
}
const SubcommandRow kTopicsRow(topic_commands, add_topics);

}  // namespace
}  // namespace skein::command

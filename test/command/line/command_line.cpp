// What the command line says of itself.
#include "command/line/command_line.hpp"

#include <catch2/catch.hpp>
#include <sstream>

#include "command/line/completion.hpp"
#include "command/line/familiar_names.hpp"
#include "command/line/help.hpp"
#include "command/line/manual.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace skein::command;
using Catch::Contains;

namespace {

struct CommandLineRun {
  CLI::App app;
  int result = 0;

  CommandLineRun() { make_command_line(app, result); }

  /// The command that the words of `text` begin with, `skein` first; nothing where there is none.
  const CLI::App* command_of(const std::string& text) const {
    const CLI::App* found = nullptr;
    for_each_command(app, [&](const CLI::App& command, const std::string& words) {
      if ((text + " ").starts_with(words + " ")) found = &command;
    });
    return found;
  }

  /// Calls `check` for each command, with its words as what is captured.
  template <typename Check>
  void each(Check check) const {
    for_each_command(app, [&](const CLI::App& command, const std::string& words) {
      CAPTURE(words);
      check(command, words);
    });
  }
};

/// The command lines that the end of a command's help shows, which may call Skein twice.
std::vector<std::string> examples_of(const CLI::App& command) {
  std::vector<std::string> examples;
  std::istringstream lines(command.get_footer());
  bool begun = false;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(' ')) begun = line == "Examples:";
    if (!begun || !line.starts_with("  ") || line.starts_with("   ")) continue;
    std::size_t at = line.find("skein ");
    while (at != std::string::npos) {
      const std::size_t next = line.find("skein ", at + 1);
      examples.push_back(line.substr(at, next - at));
      at = next;
    }
  }
  return examples;
}

/// Why the command line is wrong. Nothing of it is run.
std::string refusal(const char* text) {
  CommandLineRun line;
  try {
    line.app.parse(text);
  } catch (const CLI::ParseError& error) {
    return error.what();
  }
  return "taken";
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

}  // namespace

TEST_CASE("each command says what it is for, and shows how it is used") {
  const CommandLineRun line;
  line.each([&](const CLI::App& command, const std::string&) {
    CHECK(!summary_of(command).empty());
    CHECK(summary_of(command).size() <= 75);
    CHECK(!examples_of(command).empty());
  });
}

TEST_CASE("examples name commands and options that there are") {
  const CommandLineRun line;
  line.each([&](const CLI::App& command, const std::string&) {
    for (const std::string& example : examples_of(command)) {
      CAPTURE(example);
      const CLI::App* called = line.command_of(example);
      REQUIRE(called);
      CHECK(shown_commands(*called).empty());
      for (const std::string& word : words_of(example)) {
        if (word.starts_with("--")) CHECK(called->get_option_no_throw(word) != nullptr);
      }
    }
  });
}

TEST_CASE(
    "each option says what it does; one with a value, in which unit and what stands without it") {
  const CommandLineRun line;
  line.each([&](const CLI::App& command, const std::string&) {
    for (const CLI::Option* option : command.get_options()) {
      CAPTURE(option->get_name());
      CHECK(!option->get_description().empty());
      if (option->get_items_expected_max() == 0) continue;
      // These are CLI11's words for C++ types, which tell nobody a unit.
      for (const char* type : {"TEXT", "UINT", "FLOAT", ":"})
        CHECK_THAT(option->get_type_name(), !Contains(type));
      CHECK((option->get_required() || text_of(*option).find("default: ") != std::string::npos));
    }
  });
}

TEST_CASE("help fits into 80 columns and does not lose a word") {
  const CommandLineRun line;
  line.each([&](const CLI::App& command, const std::string& words) {
    const std::string help = command.get_formatter()->make_help(&command, words, {});
    std::istringstream lines(help);
    for (std::string text; std::getline(lines, text);) {
      CAPTURE(text);
      CHECK(text.size() <= 80);
    }
    const auto shown = words_of(help);
    for (const CLI::Option* option : command.get_options())
      for (const std::string& word : words_of(text_of(*option)))
        CHECK_THAT(shown, Catch::VectorContains(word));
  });
}

TEST_CASE("help and the manual page of the whole list every exit code once") {
  const CommandLineRun line;
  for (const std::string& text : {line.app.help(), manual_page(line.app, "skein")}) {
    for (const launch::ExitCode& row : launch::kExitCodes) {
      const std::string code = "\n  " + std::string(row.code) + "  ";
      CAPTURE(code);
      CHECK(text.find(code) != std::string::npos);
      CHECK(text.find(code) == text.rfind(code));
    }
  }
}

TEST_CASE("a manual page has the sections that people look for") {
  const CommandLineRun line;
  line.each([&](const CLI::App& command, const std::string& words) {
    const std::string page = manual_page(command, words);
    for (const char* section :
         {".SH NAME\n", ".SH SYNOPSIS\n", ".SH OPTIONS\n", ".SH \"EXAMPLES\"\n"})
      CHECK_THAT(page, Contains(section));
  });
}

TEST_CASE("numbers that make no sense are refused with the option and the range") {
  for (const char* wrong : {"echo pose --count 0", "echo pose --count -1", "echo pose --for 0",
                            "publish pose 1 --rate 0", "publish pose 1 --rate nan",
                            "publish pose 1 --rate inf", "top --every 0", "record --split 0",
                            "replay a.mcap --rate -1", "bench latency --count 0"}) {
    CAPTURE(wrong);
    CHECK_THAT(refusal(wrong), Contains("--") && Contains(": must be more than 0"));
  }
  for (const char* wrong : {"echo pose --wait -1", "echo pose --for nan", "top --every -1",
                            "call IGreeter greet --within soon", "calls --for 5x"}) {
    CAPTURE(wrong);
    CHECK_THAT(refusal(wrong), Contains("is no length of time"));
  }
}

TEST_CASE("a domain, vendor or interface that cannot be is refused with those that can") {
  for (const char* domain : {"6a", "233", "-1", "1.5", "99999999999"}) {
    CAPTURE(domain);
    for (const char* command : {"echo pose", "doctor", "bench latency"}) {
      const std::string line = std::string(command) + " --domain=" + domain;
      CHECK_THAT(refusal(line.c_str()),
                 Contains("--domain: '" + std::string(domain) + "' is no number from 0 to 232"));
    }
  }
  CHECK_THAT(refusal("services --vendor cyclone"),
             Contains("--vendor: 'cyclone' is none of ") && Contains("cyclonedds"));
  CHECK_THAT(refusal("services --interface l0"),
             Contains("--interface: this host has no interface 'l0'") &&
                 Contains("did you mean 'lo'?") && Contains("it has lo"));
}

TEST_CASE("help says once what a length of time is, where an option takes one") {
  const CommandLineRun line;
  line.each([&](const CLI::App& command, const std::string& words) {
    const std::string help = command.get_formatter()->make_help(&command, words, {});
    const std::size_t first = help.find(kDurationHelp);
    CHECK((first != std::string::npos) == takes_duration(command));
    CHECK(first == help.rfind(kDurationHelp));
  });
}

TEST_CASE(
    "each kind of command lists its exit codes, and the whole what each means for each kind") {
  const CommandLineRun line;
  const auto lists = [](const CLI::App& command, const launch::CommandKind& kind) {
    const std::string footer = command.get_footer();
    const auto listed = words_of(footer.substr(footer.find("Exit codes:")));
    std::size_t own = 0;
    for (const launch::ExitCode& row : launch::kExitCodes) {
      CAPTURE(command.get_name(), std::string(row.code), std::string(row.meaning));
      if (row.of && row.of != &kind) continue;
      const auto words = words_of(std::string(row.code) + " " + std::string(row.meaning));
      CHECK_FALSE(std::ranges::search(listed, words).empty());
      own += words.size();
    }
    CHECK(listed.size() == own + 2);  // and the heading
  };
  for (const char* command : {"call", "echo", "describe", "info"})
    lists(*line.command_of(std::string("skein ") + command), launch::kLooking);
  for (const char* command : {"status", "restart"})
    lists(*line.command_of(std::string("skein ") + command), launch::kAsking);
  for (const char* command : {"check", "script", "new"})
    lists(*line.command_of(std::string("skein ") + command), launch::kPlanning);
  lists(*line.command_of("skein launch"), launch::kLaunch);
  lists(*line.command_of("skein doctor"), launch::kDoctor);
  const auto all = words_of(line.app.help());
  for (const launch::ExitCode& row : launch::kExitCodes) {
    const std::string of = row.of ? std::string(row.of->name) + ": " : "";
    CHECK_FALSE(std::ranges::search(all, words_of(of + std::string(row.meaning))).empty());
  }
}

TEST_CASE("the help of decisions says what is true until a decision is made") {
  const CommandLineRun line;
  const std::string decisions = line.command_of("skein decisions")->get_description();
  CHECK_THAT(decisions, Contains("nothing until the next one"));
}

TEST_CASE("what users of other software type leads to a command that there is") {
  const CommandLineRun line;
  for (const FamiliarName& name : familiar_names()) {
    CAPTURE(name.theirs, name.ours);
    CHECK(line.command_of("skein " + name.ours) != &line.app);
    CHECK(!shown_commands(*line.command_of("skein " + name.theirs)).empty());
  }
  CHECK(familiar_name({"service", "list", "-t"}) == "services");
  CHECK(familiar_name({"nothing", "of", "this"}).empty());
}

TEST_CASE("a word that an option does not know is refused with those that it knows") {
  CHECK_THAT(refusal("completion fishh"),
             Contains("SHELL: 'fishh' is none of bash, zsh, fish (did you mean 'fish'?)"));
  CHECK_THAT(refusal("graph --format pdf"),
             Contains("--format: 'pdf' is none of dot, mermaid, json, svg, png"));
  const CommandLineRun line;
  line.each([&](const CLI::App& command, const std::string& words) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_type_name().find('|') == std::string::npos) continue;
      CAPTURE(option->get_name());
      CommandLineRun tried;
      auto* checked =
          const_cast<CLI::App*>(tried.command_of(words))->get_option(option->get_name());
      checked->add_result("neither");
      CHECK_THROWS_AS(checked->run_callback(), CLI::ValidationError);
    }
  });
}

TEST_CASE("what a domain is asked for to complete a command line is told by the options' types") {
  const CommandLineRun line;
  const auto asked = [&](std::vector<std::string> words) {
    const Completion completion = completion_of(line.app, std::move(words));
    return completion.live + " " + completion.before;
  };
  CHECK(asked({"echo", "po"}) == "topic ");
  CHECK(asked({"call", "--domain", "47", "IGr"}) == "service ");
  CHECK(asked({"call", "IGreeter", ""}) == "operation IGreeter");
  CHECK(asked({"param", "set", "beacon", "P"}) == "parameter beacon");
  CHECK(asked({"record", "--topics", "po"}) == "topic ");
  CHECK(asked({"replay", "flight.mcap", "--topics", "po"}) ==
        " flight.mcap");  // they are the file's
  CHECK(asked({}) == " ");
  CHECK(asked({"echo", "pose", "more"}) == " pose");
}

TEST_CASE("a value that is glued to its option is completed with it") {
  const CommandLineRun line;
  using Lines = std::vector<std::string>;
  CHECK(completion_of(line.app, {"completion", "b"}).lines == Lines{"bash"});
  CHECK(completion_of(line.app, {"graph", "--format=m"}).lines == Lines{"--format=mermaid"});
  CHECK(completion_of(line.app, {"graph", "--profile=m"}).lines.empty());
}

TEST_CASE("what sets nothing is refused with how it is written") {
  for (const char* wrong : {"launch mission.xml --set lift=3", "check mission.xml --set lift=3.5"})
    CHECK_THAT(refusal(wrong), Contains("--set: ") && Contains("PEER.PARAMETER=VALUE") &&
                                   Contains("a variable is set by --variable"));
  CHECK_THAT(refusal("launch mission.xml --set navigator.grid"), Contains("is no setting"));
  CHECK_THAT(refusal("launch mission.xml --variable lift"), Contains("write NAME=VALUE"));
}

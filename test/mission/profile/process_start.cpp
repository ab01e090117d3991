#include "mission/profile/process_start.hpp"

#include <catch2/catch.hpp>

#include "profile_folder.hpp"

using namespace skein::profile;

TEST_CASE("A peer may be any program, with or without a description") {
  ProfileFolder folder;
  CHECK(folder.check(R"(<peer name="log" program="logger"><argument value="-s"/></peer>
<peer name="n" component="n.xml"><csp component="p.xml"/></peer>
<peer name="f" component="f.xml" program="./flight_controller" ready="told" restart="always"
      process_cpus="0-1"/>)") == "");
}

TEST_CASE("A CSP in a process of its own may be any program, which obeys what programs obey") {
  ProfileFolder folder;
  const auto check = [&](const std::string& attributes, const std::string& content) {
    return folder.check(
        R"(<peer name="n" component="n.xml"><csp component="p.xml" process="own" )" + attributes +
        ">" + content + R"(</csp></peer><peer name="f" component="f.xml"/>)");
  };
  CHECK(check(R"(program="python3" ready="told" restart="always" process_cpus="0")",
              R"(<argument value="p.py"/><environment name="A" value="1"/>)") == "");
  CHECK_THAT(check(R"(program="true" plugin="x" vendor="fastdds")",
                   R"(<parameter name="Time limit" value="1"/>)"),
             Catch::Contains("error: plugin has no effect on a program of one's own") &&
                 Catch::Contains("error: vendor has no effect on a program of one's own") &&
                 Catch::Contains("error: <parameter> has no effect on a program of one's own"));
}

TEST_CASE("What nobody would obey at a program is a finding") {
  ProfileFolder folder;
  const auto [attributes, content, word] = GENERATE(table<std::string, std::string, std::string>({
      {"plugin=\"x\"", "", "plugin"},
      {"vendor=\"fastdds\"", "", "vendor"},
      {"threads=\"2\"", "", "threads"},
      {"lock_memory=\"true\"", "", "lock_memory"},
      {"strategy=\"fixed_order\"", "", "strategy"},
      {"", "<csp component=\"p.xml\"/>", "<csp>"},
      {"", "<parameter name=\"Time limit\" value=\"1\"/>", "<parameter>"},
  }));
  CHECK_THAT(folder.check("<peer name=\"log\" program=\"logger\" " + attributes + ">" + content +
                          "</peer>"),
             Catch::Contains("error: " + word + " has no effect on a program of one's own"));
}

TEST_CASE("A program takes no notice of what its group and its mission say to others") {
  ProfileFolder folder;
  folder.write("m.xml", R"(<mission name="m" vendor="cyclonedds" plugin="x">
<group name="g" threads="2"><peer name="log" program="logger"/></group></mission>)");
  CHECK(folder.without_folder(to_text(check_file(folder.path() / "m.xml"))) == "");
}

TEST_CASE("Mistakes in how a process is started are findings") {
  ProfileFolder folder;
  const auto [attributes, content, finding] =
      GENERATE(table<std::string, std::string, std::string>({
          {"ready=\"told\"", "", "ready is for a program of one's own"},
          {"process_cpus=\"0,x\"", "", "\"0,x\" is no list of CPUs"},
          {"", "<environment name=\"A B\" value=\"1\"/>", "is no name of an environment variable"},
          {"", "<environment name=\"SKEIN_READY_FD\" value=\"1\"/>", "is set by the launcher"},
          {"", "<environment value=\"1\"/>", "<environment> has no name"},
          {"", "<environment name=\"A\"/>", "<environment> has no value"},
          {"", "<environment name=\"A\" value=\"1\"/><environment name=\"A\" value=\"2\"/>",
           "the environment variable \"A\" is there twice"},
          {"", "<argument>x</argument>", "<argument> has no value"},
          {"program=\"\"", "", "<peer> has an empty program"},
          {"program=\"x\" ready=\"tld\"", "", "ready is \"tld\"; did you mean 'told'?"},
      }));
  CAPTURE(attributes, content);
  CHECK_THAT(folder.check("<peer name=\"f\" component=\"f.xml\" " + attributes + ">" + content +
                          "</peer>"),
             Catch::Contains(finding));
}

TEST_CASE("A CSP without a process of its own has nothing to start") {
  ProfileFolder folder;
  const auto text = folder.check(R"(<peer name="n" component="n.xml">
<csp component="p.xml" process_cpus="0" program="p"><environment name="A" value="1"/>
<argument value="1"/></csp></peer>)");
  CHECK_THAT(text, Catch::Contains("m.xml:3:24: error: process_cpus is for processes") &&
                       Catch::Contains("error: program is for processes") &&
                       Catch::Contains("error: <environment> is for processes") &&
                       Catch::Contains("error: <argument> is for processes"));
}

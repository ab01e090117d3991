"""What it takes to add a subcommand of `skein`."""

from additions import Edit, NewFile

MOST = 4
EDITS = (
    NewFile(
        "src/command/look/dummy.cpp",
        text="""#include <cstdio>

#include "command/commands.hpp"

namespace skein::command {

int show_dummy(const DummyArguments& arguments) {
  std::printf("domain %u, after %g s\\n", arguments.watched_domain(), arguments.seconds);
  return 0;
}

}  // namespace skein::command
""",
    ),
    Edit("src/command/CMakeLists.txt", after="look/describe.cpp ", text="look/dummy.cpp "),
    Edit(
        "src/command/commands.hpp",
        before="struct TopicsArguments : Onlooker {\n",
        text="""struct DummyArguments : Onlooker {
  double seconds = 1.5;
};

/// `skein dummy`: tells what it was told.
int show_dummy(const DummyArguments& arguments);

""",
    ),
    Edit(
        "src/command/line/inspection_commands.cpp",
        after="const SubcommandRow kDesignerRow(inspection_commands, add_designer);\n",
        text="""
void add_dummy(CLI::App& app, int& result) {
  auto& command = add_command(app, "dummy", "Tell what it was told",
                              {{"skein dummy --domain 47", "The domain, and how long to wait"}});
  auto& arguments = arguments_of(command, show_dummy, result);
  add_onlooker(command, arguments);
  add_wait(command, arguments.seconds);
  add_exit_codes(command);
}
const SubcommandRow kDummyRow(inspection_commands, add_dummy);
""",
    ),
)
TARGETS = ("skein_command", "skein_command_texts", "command_line_test", "onlooker_test", "interruption_test")
TESTS = "^(command_line_test|command_texts_test|onlooker_test|interruption_test)$"

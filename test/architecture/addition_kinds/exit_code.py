"""What it takes to add an exit code: its constant, its row, its cause, and the test that ends a command with it."""

from additions import Edit

MOST = 4
EDITS = (
    Edit("src/mission/process/exit_codes.hpp", after="inline constexpr int kConfigurationError = 78;\n",
         text="inline constexpr int kDummy = 99;\n"),
    Edit("src/mission/process/exit_codes.hpp", before='    ExitCode{&kLooking, "124", ', text='    ExitCode{&kLaunch, "99", "a dummy"},\n'),
    Edit("src/command/mission/check.cpp", after="int check(const CheckArguments& arguments) {\n",
         text='  if (arguments.profile == "dummy.xml") return launch::kDummy;\n'),
    Edit("test/command/mission/exit_codes_test.cpp", before="\n  const std::string whole = ",
         text='  table.expect(launch::kDummy, {"check", "dummy.xml"});\n'),
)
TARGETS = ("skein_command_texts", "exit_codes_test", "command_line_test")
TESTS = "^(exit_codes_test|command_line_test|command_texts_test)$"

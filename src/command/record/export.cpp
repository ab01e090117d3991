#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "command/commands.hpp"
#include "command/print/json_output.hpp"
#include "core/system/whole_file.hpp"
#include "recording/viewers/perfetto_trace.hpp"

namespace skein::command {

int export_recording(const ExportArguments& arguments) {
  const recording::Reader reader(arguments.file);
  if (std::filesystem::exists(arguments.perfetto)) {
    throw WriteFailed("the trace '" + arguments.perfetto +
                      "' is there already; name another file, or remove that one");
  }
  const auto done = recording::export_to_perfetto(reader, arguments.perfetto);
  if (arguments.json) {
    print_json({{"file", arguments.perfetto},
                {"events", done.events},
                {"decisions", done.decisions},
                {"malformed", done.malformed}},
               false);
    return 0;
  }
  std::printf("%s: %zu events of calls, %zu decisions\n", arguments.perfetto.c_str(), done.events,
              done.decisions);
  if (done.malformed > 0) {
    std::fprintf(stderr, "skein: %zu messages could not be read\n", done.malformed);
  }
  return 0;
}

}  // namespace skein::command

// Entry of a fuzzer (libFuzzer's convention), which the mutation test drives as well: whatever the
// bytes are, reading them ends in a value or in a DescriptionError, and what was read can be
// written.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mission/component/component_xml.hpp"
#include "mission/component/dictionary.hpp"

using namespace skein::profile;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const auto written = write_component(parse_component(text, "fuzz"));
    if (write_component(parse_component(written, "written")) != written) std::abort();
  } catch (const DescriptionError&) {
  }
  try {
    parse_dictionary(text, "fuzz");
  } catch (const DescriptionError&) {
  }
  return 0;
}

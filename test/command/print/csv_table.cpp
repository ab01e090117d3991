#include "command/record/csv_table.hpp"

#include <catch2/catch.hpp>
#include <sstream>
#include <vector>

using skein::command::CsvTable;

namespace {

/// The table of values whose times are 0, 1, ... ns.
std::string table_of(const std::vector<std::string>& values) {
  CsvTable table;
  for (const std::string& value : values) table.add(value);
  table.end();
  std::ostringstream text;
  table.write_head(text);
  for (std::size_t i = 0; i < values.size(); ++i) table.write_row(text, i, values[i]);
  return text.str();
}

}  // namespace

TEST_CASE("a table has a column for each member of any value") {
  CHECK(
      table_of({R"({"a": {"b": 1}, "c": [true, 2.5]})", R"({"a": {"b": 2}, "d": null, "e": 3})"}) ==
      "time,a.b,c[0],c[1],d,e\r\n"
      "0.000000000,1,true,2.5,,\r\n"
      "0.000000001,2,,,,3\r\n");
}

TEST_CASE("a member called time does not share its column's name with the time of the value") {
  CHECK(table_of({R"({"time": 7})"}) == "recorded_time,time\r\n0.000000000,7\r\n");
}

TEST_CASE("a table quotes texts that would break it") {
  CHECK(table_of({R"({"a": "x, \"y\"\nz", "b,": "plain"})"}) ==
        "time,a,\"b,\"\r\n0.000000000,\"x, \"\"y\"\"\nz\",plain\r\n");
}

TEST_CASE("an array that is long in any value is one column of JSON in all rows") {
  const std::string longer = "[0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16]";
  CHECK(table_of({R"({"a": [{"b": [7]}], "z": 1})", R"({"a": )" + longer + "}"}) ==
        "time,z,a\r\n0.000000000,1,\"[{\"\"b\"\":[7]}]\"\r\n0.000000001,,\"" + longer + "\"\r\n");
}

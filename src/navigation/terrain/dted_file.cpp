#include <fmt/core.h>

#include <charconv>
#include <fstream>
#include <numeric>
#include <span>
#include <string_view>

#include "navigation/terrain/degree_tile.hpp"

// MIL-PRF-89020B: three headers of ASCII (UHL, DSI, ACC), then a record for each column of posts.
namespace skein::navigation {
namespace {

constexpr std::size_t kUhlSize = 80;
constexpr std::size_t kDsiSize = 648;
constexpr std::size_t kHeadersSize = kUhlSize + kDsiSize + 2700;
constexpr std::size_t kBeforePosts = 8;  ///< Sentinel, count of blocks, number of column and row.
constexpr std::size_t kChecksumSize = 4;
constexpr unsigned char kSentinel = 0xAA;
constexpr int kVoid = -32767;
constexpr int kTenthsPerDegree = 36000;

using Bytes = std::span<const unsigned char>;

struct Layout {
  int southern_latitude_deg;
  int western_longitude_deg;
  int rows;
  int columns;
};

std::vector<unsigned char> read_bytes(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) refuse_unread(file, error);
  if (size < kHeadersSize) {
    refuse(file, fmt::format("has {} bytes; the headers of a DTED file alone have {}", size,
                             kHeadersSize));
  }
  constexpr std::uintmax_t kLargest = kHeadersSize + 3601U * (2U * 3601 + 12);
  if (size > kLargest) refuse(file, fmt::format("has {} bytes, more than any DTED file", size));
  std::vector<unsigned char> bytes(size);
  std::ifstream in(file, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) {
    refuse(file, "cannot be read to its end");
  }
  return bytes;
}

int number(std::string_view text, const char* what, const std::filesystem::path& file) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    refuse(file, fmt::format("'{}' is no {}; the header UHL is damaged", text, what));
  }
  return value;
}

/// DDDMMSSH, of the south-west corner; `hemispheres` are the positive and the negative one.
int whole_degrees(std::string_view text, const char* what, std::string_view hemispheres,
                  const std::filesystem::path& file) {
  const int degrees = number(text.substr(0, 3), what, file);
  if (text.substr(3, 4) != "0000" || degrees < 0 ||
      hemispheres.find(text[7]) == std::string_view::npos) {
    refuse(file, fmt::format("lies at {} '{}'; tiles begin at a whole degree", what, text));
  }
  return text[7] == hemispheres[1] ? -degrees : degrees;
}

Layout read_layout(std::string_view headers, const std::filesystem::path& file) {
  if (!headers.starts_with("UHL1") || headers.substr(kUhlSize, 3) != "DSI" ||
      headers.substr(kUhlSize + kDsiSize, 3) != "ACC") {
    refuse(file,
           "lacks one of the headers UHL, DSI and ACC where it must stand; it is no DTED file");
  }
  const int column_spacing = number(headers.substr(20, 4), "interval of longitude", file);
  const int row_spacing = number(headers.substr(24, 4), "interval of latitude", file);
  const Layout layout{whole_degrees(headers.substr(12, 8), "latitude", "NS", file),
                      whole_degrees(headers.substr(4, 8), "longitude", "EW", file),
                      number(headers.substr(51, 4), "number of rows", file),
                      number(headers.substr(47, 4), "number of columns", file)};
  require_between_poles(file, layout.southern_latitude_deg, layout.western_longitude_deg);
  if (row_spacing != 300 && row_spacing != 30 && row_spacing != 10) {
    refuse(file,
           fmt::format("has a post every {} tenths of a second of latitude; levels 0, 1 and 2 "
                       "have 300, 30 and 10",
                       row_spacing));
  }
  if ((layout.rows - 1) * row_spacing != kTenthsPerDegree ||
      (layout.columns - 1) * column_spacing != kTenthsPerDegree) {
    refuse(file, fmt::format("has {} rows and {} columns every {} and {} tenths of a second, which "
                             "is not one degree by one degree",
                             layout.rows, layout.columns, row_spacing, column_spacing));
  }
  return layout;
}

/// Sign and magnitude, big-endian.
int height(Bytes posts, std::size_t row) {
  const int magnitude = (posts[2 * row] & 0x7F) << 8 | posts[2 * row + 1];
  return posts[2 * row] & 0x80 ? -magnitude : magnitude;
}

void require_whole(Bytes record, int column, const std::filesystem::path& file) {
  if (record[0] != kSentinel) {
    refuse(file, fmt::format("column {} does not begin with AA; the file is damaged", column));
  }
  const int number = record[4] << 8 | record[5];
  if (number != column) {
    refuse(file, fmt::format("column {} says that it is column {}", column, number));
  }
  const Bytes sum = record.last(kChecksumSize);
  const auto said = static_cast<std::uint32_t>(sum[0]) << 24 |
                    static_cast<std::uint32_t>(sum[1]) << 16 |
                    static_cast<std::uint32_t>(sum[2]) << 8 | sum[3];
  const Bytes summed = record.first(record.size() - kChecksumSize);
  const std::uint32_t found = std::accumulate(summed.begin(), summed.end(), std::uint32_t{0});
  if (said == found) return;
  refuse(file,
         fmt::format("the checksum of column {} is {}, but its bytes add up to {}; the file is "
                     "damaged",
                     column, said, found));
}

std::vector<float> read_posts(Bytes records, const Layout& layout,
                              const std::filesystem::path& file) {
  const auto rows = static_cast<std::size_t>(layout.rows);
  const auto columns = static_cast<std::size_t>(layout.columns);
  const std::size_t record_size = kBeforePosts + 2 * rows + kChecksumSize;
  if (records.size() != columns * record_size) {
    refuse(file, fmt::format("has {} bytes after its headers; {} columns of {} rows have {}",
                             records.size(), columns, rows, columns * record_size));
  }
  std::vector<float> heights(rows * columns);
  for (std::size_t column = 0; column < columns; ++column) {
    const Bytes record = records.subspan(column * record_size, record_size);
    require_whole(record, static_cast<int>(column), file);
    for (std::size_t row = 0; row < rows; ++row) {
      const int value = height(record.subspan(kBeforePosts), row);
      if (value != kVoid) {
        require_earthly(file, value, fmt::format("column {}, row {}", column, row));
      }
      heights[row * columns + column] = value == kVoid ? kVoidPost : static_cast<float>(value);
    }
  }
  return heights;
}

}  // namespace

Terrain read_dted(const std::filesystem::path& file) {
  const std::vector<unsigned char> bytes = read_bytes(file);
  const std::string_view headers(reinterpret_cast<const char*>(bytes.data()), kHeadersSize);
  const Layout layout = read_layout(headers, file);
  return lay_out(file, {.southern_latitude_deg = layout.southern_latitude_deg,
                        .western_longitude_deg = layout.western_longitude_deg,
                        .rows = layout.rows,
                        .columns = layout.columns,
                        .heights_m = read_posts(Bytes(bytes).subspan(kHeadersSize), layout, file)});
}

}  // namespace skein::navigation

#include "cyclone_log.hpp"

#include <dds/ddsrt/log.h>

#include <string_view>

#include "core/log.hpp"
#include "dds/rtps/repeated_messages.hpp"

namespace skein::dds::cyclonedds {
namespace {

constexpr const char* kPlace = "dds/cyclonedds";

thread_local std::string* captured = nullptr;

void tell(LogLevel level, std::string_view text) {
  static auto* repeated = new RepeatedMessages;  // Cyclone's threads may log until the very end
  if (const auto message = repeated->next(text)) log(level, kPlace, *message);
}

void take_message(void*, const dds_log_data_t* data) {
  std::string_view text(data->message, data->size);
  while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  const bool error = (data->priority & (DDS_LC_ERROR | DDS_LC_FATAL)) != 0;
  if (error && captured != nullptr) {
    captured->append(captured->empty() ? "" : "; ").append(text);
  } else if (error) {
    tell(LogLevel::Error, text);
  } else if ((data->priority & DDS_LC_WARNING) != 0) {
    tell(LogLevel::Warning, text);
  }
}

}  // namespace

void route_log() { dds_set_log_sink(take_message, nullptr); }

ErrorCapture::ErrorCapture() { captured = new std::string; }

ErrorCapture::~ErrorCapture() {
  delete captured;
  captured = nullptr;
}

std::string ErrorCapture::text() const { return captured->empty() ? "no reason given" : *captured; }

}  // namespace skein::dds::cyclonedds

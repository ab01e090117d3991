#include "log.hpp"

#include <dds/ddsrt/log.h>

#include <string_view>

#include "skein/core/log.hpp"

namespace skein::dds::cyclonedds {
namespace {

thread_local std::string* captured = nullptr;

void take_message(void*, const dds_log_data_t* data) {
  std::string_view text(data->message, data->size);
  while (!text.empty() && text.back() == '\n') text.remove_suffix(1);
  const bool error = (data->priority & (DDS_LC_ERROR | DDS_LC_FATAL)) != 0;
  if (error && captured != nullptr) {
    captured->append(captured->empty() ? "" : "; ").append(text);
  } else if (error || (data->priority & DDS_LC_WARNING) != 0) {
    log(error ? LogLevel::Error : LogLevel::Warning, "dds/cyclonedds", text);
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

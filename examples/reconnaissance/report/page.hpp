#pragma once

#include <string>

namespace reconnaissance {

/// A page that a script inside of it (page.js) draws from a record in JSON.
std::string page_of(const std::string& json);

}  // namespace reconnaissance

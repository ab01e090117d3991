#pragma once

/// The parts of the page that are the same for each mission: page.css, page.html and page.js, which
/// the build puts into the library.
namespace reconnaissance::page {

extern const char* const kStyle;
extern const char* const kBody;
extern const char* const kScript;

}  // namespace reconnaissance::page

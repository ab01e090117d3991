#pragma once

#include <string>

namespace skein::command::designer {

/// Opens a page in the desktop's browser, if there is a desktop. The browser gets the address in a
/// file that other users cannot read, not on its command line, which all can; and none of this
/// process's sockets. Nobody waits for it.
class Browser {
 public:
  explicit Browser(const std::string& url);
  /// Removes the file.
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

 private:
  std::string folder_;
};

}  // namespace skein::command::designer

#pragma once

#include <string>
#include <typeinfo>

namespace skein {

/// A module or plugin, opened for the rest of the process's life: unloading code whose threads and
/// thread-local destructors may still run is not survivable.
class SharedObject {
 public:
  /// `name` is `skein_fastdds` for `libskein_fastdds.so`, or a path. Looks in the directories that
  /// SKEIN_MODULE_PATH lists, in libskein's own and its `skein/`, then where the loader looks.
  /// Throws Unavailable with the places looked in, or with the loader's reason followed by
  /// `remedy`; InvalidArgument for a user's object that every user may replace: its constructors
  /// are not run.
  enum class Maker { Skein, User };
  SharedObject(const std::string& name, const std::string& remedy, Maker maker = Maker::Skein);

  /// Throws InvalidArgument where the object exports no such symbol, and says so where it does as
  /// C++, without `extern "C"`.
  template <class Function>
  Function* function(const char* symbol) const {
    return reinterpret_cast<Function*>(find(symbol, typeid(Function).name()));
  }

  const std::string& file() const noexcept { return file_; }

  /// Throws InvalidArgument unless the object's `symbol()` gives this library's SKEIN_ABI.
  void check_abi(const char* symbol) const;

 private:
  void* find(const char* symbol, const std::string& function) const;

  std::string file_;
  void* handle_ = nullptr;
};

}  // namespace skein

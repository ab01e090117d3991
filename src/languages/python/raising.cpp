#include "raising.hpp"

#include <atomic>

#include "interface.hpp"

namespace skein::python {
namespace {

py::tuple& error_classes() {
  static auto& classes = *new py::tuple();
  return classes;
}

/// The place for errors of one thread.
struct ThreadSink {
  std::shared_ptr<c::ErrorSink> sink = std::make_shared<c::ErrorSink>();
  skein_error handle = c::add(sink);
  ThreadSink() = default;
  ThreadSink(const ThreadSink&) = delete;
  ThreadSink& operator=(const ThreadSink&) = delete;
  ~ThreadSink() { skein_error_free(handle); }
};

ThreadSink& thread_sink() {
  static thread_local ThreadSink mine;
  return mine;
}

std::atomic<bool> forked{false};

}  // namespace

void set_error_classes(py::tuple classes) { error_classes() = std::move(classes); }

void raise(const c::Failure& failure, const Interface* known) {
  if (failure.kind == SKEIN_DECLARED && known && failure.cdr) {
    const py::object exception = known->exception(failure.exception, *failure.cdr);
    PyErr_SetObject(py::type::handle_of(exception).ptr(), exception.ptr());
  } else {
    const auto kind = static_cast<std::size_t>(failure.kind);
    const py::object made = error_classes()[kind < error_classes().size() ? kind : 0];
    const auto text = py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(
        failure.text.data(), static_cast<Py_ssize_t>(failure.text.size()), "replace"));
    if (text) PyErr_SetObject(made.ptr(), text.ptr());
  }
  throw py::error_already_set();
}

void refuse(const std::string& text) { raise({SKEIN_INVALID_ARGUMENT, text}); }

std::shared_ptr<const c::Failure> last_failure() { return thread_sink().sink->last(); }

skein_error sink() { return thread_sink().handle; }

void forbid_after_fork() { forked = true; }

bool is_forked() { return forked; }

void refuse_after_fork() {
  if (!forked) return;
  throw std::runtime_error(
      "this process was forked from one that uses Skein, whose threads do not run here; start it "
      "anew: multiprocessing.set_start_method('spawn'), or subprocess");
}

}  // namespace skein::python

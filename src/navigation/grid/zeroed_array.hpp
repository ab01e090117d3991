#pragma once

#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

namespace skein::navigation::grid {

/// An array of zeros that takes memory only where it is written: most of a large map is never
/// visited.
template <class Element>
class ZeroedArray {
  static_assert(std::is_trivial_v<Element>);

 public:
  explicit ZeroedArray(std::size_t size)
      : elements_(static_cast<Element*>(std::calloc(size, sizeof(Element)))) {
    if (!elements_) throw std::bad_alloc();
  }

  Element& operator[](std::size_t index) { return elements_.get()[index]; }
  const Element& operator[](std::size_t index) const { return elements_.get()[index]; }

 private:
  struct Free {
    void operator()(Element* elements) const { std::free(elements); }
  };
  std::unique_ptr<Element[], Free> elements_;
};

}  // namespace skein::navigation::grid

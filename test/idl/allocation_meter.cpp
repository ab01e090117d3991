#include "allocation_meter.hpp"

#include <cstdlib>
#include <new>

namespace {
thread_local std::size_t handed_out = 0;
}

std::size_t AllocationMeter::total() { return handed_out; }

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  handed_out += size;
  return std::malloc(size);
}

void* operator new(std::size_t size) {
  if (void* memory = operator new(size, std::nothrow)) return memory;
  throw std::bad_alloc();
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

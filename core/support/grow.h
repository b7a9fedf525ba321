#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vat {

/// Resizes a vector whose length varies between steps. If the capacity is too small, it grows by an
/// eighth, or to the required size if that is more. std::vector would double the capacity.
template <class T>
void resize_closely(std::vector<T>& column, std::size_t size) {
  if (size > column.capacity()) {
    column.reserve(std::max(size, column.capacity() + column.capacity() / 8));
  }
  column.resize(size);
}

/// Appends a value. If the capacity is exhausted, it grows by an eighth, or by 8 elements if that
/// is more.
template <class T>
void add_closely(std::vector<T>& column, const T& value) {
  constexpr std::size_t kLeast = 8;
  if (column.size() == column.capacity()) {
    column.reserve(column.size() + std::max(kLeast, column.size() / 8));
  }
  column.push_back(value);
}

}  // namespace vat

#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vat {

/// Resizes a column whose length varies between steps. If it must grow, its capacity grows by an
/// eighth, or to the required size if this is more. A vector would double it.
template <class T>
void resize_closely(std::vector<T>& column, std::size_t size) {
  if (size > column.capacity()) {
    column.reserve(std::max(size, column.capacity() + column.capacity() / 8));
  }
  column.resize(size);
}

/// Appends a value. The capacity grows by an eighth.
template <class T>
void add_closely(std::vector<T>& column, const T& value) {
  constexpr std::size_t kLeast = 8;
  if (column.size() == column.capacity()) {
    column.reserve(column.size() + std::max(kLeast, column.size() / 8));
  }
  column.push_back(value);
}

}  // namespace vat

#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vat {

/// Resizes a column whose length varies from step to step: where it must grow it gets room for an
/// eighth more than it had, or just what is asked for. A vector by itself would double.
template <class T>
void resize_closely(std::vector<T>& column, std::size_t size) {
  if (size > column.capacity()) {
    column.reserve(std::max(size, column.capacity() + column.capacity() / 8));
  }
  column.resize(size);
}

/// Adds to its end in the same way.
template <class T>
void add_closely(std::vector<T>& column, const T& value) {
  constexpr std::size_t kLeast = 8;
  if (column.size() == column.capacity()) {
    column.reserve(column.size() + std::max(kLeast, column.size() / 8));
  }
  column.push_back(value);
}

}  // namespace vat

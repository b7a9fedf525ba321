#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "core/support/check.h"

namespace vat {

/// Constant array that all copies share. The cost of a copy does not depend on its size.
template <class T>
class SharedArray {
 public:
  SharedArray() = default;
  SharedArray(std::vector<T> values) : size_(values.size()) {
    const auto owner = std::make_shared<const std::vector<T>>(std::move(values));
    data_ = {owner, owner->data()};
  }

  const T* data() const { return data_.get(); }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const T& operator[](std::size_t i) const {
    VAT_ASSERT(i < size_);
    return data()[i];
  }
  const T& back() const {
    VAT_ASSERT(size_ > 0);
    return data()[size_ - 1];
  }

 private:
  std::shared_ptr<const T> data_;
  std::size_t size_ = 0;
};

}  // namespace vat

#pragma once

#include <cstddef>
#include <string_view>

namespace vat {

/// What stands in the way of keeping something more.
struct SavedExcess {
  std::string_view limit;  ///< its name in server.info's `limits`
  std::size_t maximum = 0;
};

}  // namespace vat

#pragma once

#include <cstddef>
#include <string_view>

namespace vat {

/// Limit that a request would exceed.
struct LimitExcess {
  std::string_view limit;  ///< name in server.info's `limits`
  std::size_t maximum = 0;
};

}  // namespace vat

#pragma once

#include <array>
#include <stdexcept>
#include <string>

#include "core/support/names.h"

namespace vat {

/// Failed read or write of stored data. The failed operation has no effect.
class StorageError : public std::runtime_error {
 public:
  enum class Kind {
    full,         ///< no space on the disk, or a limit is reached
    read_only,    ///< the folder or a file in it is read-only
    corrupt,      ///< a file is damaged, or is not a database of this program
    newer,        ///< database of a later version of this program
    locked,       ///< another server uses the folder
    failed,       ///< all other system errors
    unreachable,  ///< the servers that store the log do not answer
    name_used     ///< another session of the cluster has the name
  };

  StorageError(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};
template <>
inline constexpr std::array kNamesOf<StorageError::Kind>{
    "full", "read_only", "corrupt", "newer", "locked", "failed", "unreachable", "name_used"};

}  // namespace vat

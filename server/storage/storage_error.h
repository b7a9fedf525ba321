#pragma once

#include <stdexcept>
#include <string>

namespace vat {

/// Why something could not be kept, or read back. Thrown by all of server/storage/; what was under
/// way is then undone as a whole.
class StorageError : public std::runtime_error {
 public:
  enum class Kind {
    full,       ///< the disk, or what is allowed of it
    read_only,  ///< the folder or a file in it may not be written
    corrupt,    ///< a file is damaged, or is no database of this program
    newer,      ///< a database of a later version of this program
    locked,     ///< another server uses the folder
    failed      ///< all else that the system refuses
  };

  StorageError(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

}  // namespace vat

#pragma once

#include <string>

namespace vat {

/// A folder that holds all that a server keeps, made where there is none, and locked: one server a
/// folder. Throws StorageError, of kind locked where another process has it.
class DataFolder {
 public:
  explicit DataFolder(std::string path);
  ~DataFolder();
  DataFolder(const DataFolder&) = delete;
  DataFolder& operator=(const DataFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
  int lock_ = -1;
};

}  // namespace vat

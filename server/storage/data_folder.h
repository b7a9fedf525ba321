#pragma once

#include <string>

namespace vat {

/// Folder of a server's data. Created if it is missing, and locked for one server. Throws
/// StorageError, of kind locked if another process uses it.
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

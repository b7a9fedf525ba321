#pragma once

#include <string>

namespace vat {

/// Data folder of a server. The constructor creates a missing folder and locks the folder for one
/// server. Throws StorageError, with the kind `locked` if another process uses the folder.
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

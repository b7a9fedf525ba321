#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace vat::test {

/// A separate folder for one test. The destructor removes it with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const std::string pattern = "vat-test-" + std::string(6, 'X');  // mkdtemp's pattern
    std::string name = (std::filesystem::temp_directory_path() / pattern).string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;  // nothing depends on the removal
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Returns the path of a file in the folder.
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  /// Returns the sorted names of the folder's entries.
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
  }
  void write(const std::filesystem::path& name, const std::string& content) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream file(path_ / name, std::ios::binary);
    file << content;
    if (!file.flush()) throw std::runtime_error("cannot write " + name.string());
  }

 private:
  std::filesystem::path path_;
};

}  // namespace vat::test

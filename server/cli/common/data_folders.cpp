#include "server/cli/common/data_folders.h"

#include <filesystem>
#include <system_error>

namespace vat {
namespace {

namespace fs = std::filesystem;

/// A folder of a build is a link into the source tree, which users know.
std::string data_folder(const char* name) {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  const fs::path folder = program.parent_path().parent_path() / "share" / "vat" / name;
  const fs::path target = fs::canonical(folder, failed);
  return (failed ? folder : target).string();
}

}  // namespace

std::string installed_scenes_folder() {
  return data_folder("scenes");
}

std::string installed_web_folder() {
  return data_folder("web");
}

}  // namespace vat

#include "protocol/files/output_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace vat {

namespace fs = std::filesystem;

namespace {

Error errno_error(const std::string& name, const char* what) {
  return {"io_error", name, std::string(what) + ": " + std::strerror(errno)};
}

// A link is followed, so that commit() replaces the file it points to and not the link.
std::string resolve(const std::string& name) {
  std::error_code failed;
  const fs::path target = fs::canonical(name, failed);
  return failed ? name : target.string();
}

// Renaming a file over /dev/null would remove the device.
bool is_special(const std::string& name) {
  std::error_code failed;
  const fs::file_status status = fs::status(name, failed);
  return fs::exists(status) && !fs::is_regular_file(status);
}

}  // namespace

OutputFile::OutputFile(std::string name, std::string written_name, std::FILE* file)
    : name_(std::move(name)), written_name_(std::move(written_name)), file_(file) {}

Result<OutputFile> OutputFile::create(const std::string& name) {
  const std::string target = resolve(name);
  const std::string written_name = is_special(target) ? target : target + ".part";
  std::FILE* file = std::fopen(written_name.c_str(), "wb");
  if (file == nullptr) return errno_error(name, "cannot be created");
  return OutputFile(name, written_name, file);
}

Error OutputFile::system_error(const char* what) const {
  return errno_error(name_, what);
}

Status OutputFile::append(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) {
    return system_error("cannot be written");
  }
  return {};
}

Status OutputFile::write_at(std::size_t offset, std::string_view bytes) {
  if (std::fseek(file_.get(), static_cast<long>(offset), SEEK_SET) != 0)
    return system_error("cannot be written");
  if (Status written = append(bytes); !written) return written;
  if (std::fseek(file_.get(), 0, SEEK_END) != 0) return system_error("cannot be written");
  return {};
}

Status OutputFile::commit() {
  if (std::fclose(file_.release()) != 0) return system_error("cannot be written");
  const std::string target = resolve(name_);
  if (written_name_ == target) return {};
  if (std::rename(written_name_.c_str(), target.c_str()) != 0) {
    return system_error("cannot be renamed from its .part");
  }
  return {};
}

Status write_output_file(const std::string& name, std::string_view content) {
  Result<OutputFile> file = OutputFile::create(name);
  if (!file) return file.errors();
  if (Status written = file.value().append(content); !written) return written;
  return file.value().commit();
}

}  // namespace vat

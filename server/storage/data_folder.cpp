#include "server/storage/data_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "server/storage/sqlite/storage_error.h"

namespace vat {
namespace {

constexpr int kOwnerOnly = 0700;  // sessions are private

StorageError::Kind kind_of(int error) {
  switch (error) {
    case EACCES:
    case EPERM:
    case EROFS:
    case ENOENT:
      return StorageError::Kind::read_only;
    case ENOSPC:
    case EDQUOT:
      return StorageError::Kind::full;
    default:
      return StorageError::Kind::failed;
  }
}

[[noreturn]] void fail(const std::string& path, int error) {
  throw StorageError(kind_of(error), path + " cannot be written: " + std::strerror(error));
}

}  // namespace

DataFolder::DataFolder(std::string path) : path_(std::move(path)) {
  std::error_code failed;
  const bool made = std::filesystem::create_directories(path_, failed);
  if (failed) fail(path_, failed.value());
  if (made) std::filesystem::permissions(path_, std::filesystem::perms{kOwnerOnly}, failed);
  const std::string name = file("lock");
  lock_ = open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock_ < 0) fail(name, errno);
  if (flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
  const int error = errno;
  close(lock_);
  if (error != EWOULDBLOCK) fail(name, error);
  throw StorageError(StorageError::Kind::locked, path_ + " is used by another server");
}

DataFolder::~DataFolder() {
  close(lock_);
}

}  // namespace vat

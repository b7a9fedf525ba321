#include "protocol/recording/recording_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace vat {
namespace {

constexpr std::string_view kCommandRecordingMagic = "vat.rec\n";

Errors with_name(const std::string& name, Errors errors) {
  for (Error& error : errors) error.path = name;
  return errors;
}

bool is_command_recording(std::span<const std::uint8_t> begin) {
  return begin.size() >= kCommandRecordingMagic.size() &&
         std::ranges::equal(begin.first(kCommandRecordingMagic.size()), kCommandRecordingMagic);
}

}  // namespace

Result<RecordingFile> RecordingFile::open(const std::string& name) {
  RecordingFile opened;
  opened.name_ = name;
  std::error_code failed;
  opened.size_ = std::filesystem::file_size(name, failed);
  if (failed) return Error{"io_error", name, "cannot be read: " + failed.message()};
  opened.file_.open(name, std::ios::binary);
  if (!opened.file_) {
    return Error{"io_error", name, std::string("cannot be read: ") + std::strerror(errno)};
  }
  const auto read = [&opened](std::uint64_t offset, std::size_t length) {
    return opened.read(offset, length);
  };
  Result<RecordingIndex> index = read_recording_index(opened.size_, read);
  if (!index) {
    const auto begin = opened.read(0, std::min<std::uint64_t>(opened.size_, 8));
    if (begin && is_command_recording(begin.value())) {
      return Error{"other_format", name,
                   "this recording contains the commands of a session, not frames; see vat replay"};
    }
    return with_name(name, index.errors());
  }
  opened.index_ = std::move(index).value();
  return opened;
}

Result<std::vector<std::uint8_t>> RecordingFile::read(std::uint64_t offset, std::size_t length) {
  std::vector<std::uint8_t> bytes(length);
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(offset));
  file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(length));
  if (!file_) return Error{"io_error", name_, "cannot be read"};
  return bytes;
}

Result<std::vector<std::uint8_t>> RecordingFile::frame(std::size_t number) {
  const RecordedFrame& frame = index_.frames().at(number);
  return read(frame.offset, frame.size);
}

Result<std::string> RecordingFile::description(std::size_t number) {
  const RecordedDescription& description = index_.descriptions().at(number);
  const auto bytes = read(description.offset, description.size);
  if (!bytes) return bytes.errors();
  if (!matches(description, bytes.value())) {
    return Error{"damaged", name_, "a description does not match its check"};
  }
  return std::string(bytes.value().begin(), bytes.value().end());
}

}  // namespace vat

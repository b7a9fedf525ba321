#include "protocol/recording/recording_writer.h"

#include <algorithm>
#include <utility>

namespace vat {
namespace {

constexpr std::uint64_t kCopiedBytes = std::uint64_t{1} << 20;  // at once

std::span<const std::uint8_t> text_bytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Status named(const std::string& name, Errors errors) {
  for (Error& error : errors) error.path = name;
  return errors;
}

}  // namespace

Result<RecordingWriter> RecordingWriter::create(const std::string& name) {
  Result<OutputFile> file = OutputFile::create(name);
  if (!file) return file.errors();
  RecordingWriter writer(name, std::move(file).value());
  if (Status written = writer.append(write_recording_header()); !written) return written.errors();
  return writer;
}

Status RecordingWriter::append(std::span<const std::uint8_t> bytes) {
  return file_.append({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

Status RecordingWriter::copy(RecordingFile& from, std::size_t frames) {
  index_ = from.index();
  index_.truncate(frames);
  const std::uint64_t end = index_.content_end();
  for (std::uint64_t at = RecordingIndex().content_end(); at < end; at += kCopiedBytes) {
    const auto bytes = from.read(at, static_cast<std::size_t>(std::min(kCopiedBytes, end - at)));
    if (!bytes) return bytes.errors();
    if (Status written = append(bytes.value()); !written) return written;
  }
  return {};
}

Status RecordingWriter::write(const FrameRecorder::Parts& parts) {
  if (parts.description) {
    const auto description = text_bytes(*parts.description);
    if (Status added = index_.add_description(description); !added) {
      return named(name_, added.errors());
    }
    if (Status written = append(description); !written) return written;
  }
  if (Status added = index_.add_frame(parts.frame); !added) return named(name_, added.errors());
  return append(parts.frame);
}

Status RecordingWriter::finish() {
  if (Status written = append(write_recording_index(index_)); !written) return written;
  return file_.commit();
}

}  // namespace vat

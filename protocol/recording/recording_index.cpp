#include "protocol/recording/recording_index.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/support/byte_io.h"
#include "protocol/frame/frame_codec.h"
#include "protocol/frame/frame_layout.h"

namespace vat {
namespace {

constexpr std::uint32_t kRecordingVersion = 1;
constexpr std::size_t kRecordingHeader = 12;
constexpr std::string_view kEndMagic = "vat.end\n";
constexpr std::size_t kEndSize = 16;
constexpr std::uint32_t kKeyBit = std::uint32_t{1} << 31;
constexpr std::size_t kDescriptionEntry = 12;  // [bytes]
constexpr std::size_t kFrameEntry = 4;

/// FNV-1a.
std::uint32_t fnv_of(std::span<const std::uint8_t> bytes) {
  std::uint32_t check = 2'166'136'261;
  for (const std::uint8_t byte : bytes) check = (check ^ byte) * 16'777'619;
  return check;
}

void append_text(std::vector<std::uint8_t>& bytes, std::string_view text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

Error bad_value(std::string path, std::string message) {
  return {"bad_value", std::move(path), std::move(message)};
}

Error too_many_parts(const char* path, const char* parts, std::size_t most) {
  return {"too_large", path, "a recording has at most " + std::to_string(most) + parts};
}

Status check_part_size(const char* path, std::size_t size, std::size_t least) {
  if (size >= least && size <= kMaxRecordedBytes) return {};
  return bad_value(path, "must have from " + std::to_string(least) + " to " +
                             std::to_string(kMaxRecordedBytes) + " bytes");
}

Status check_description_size(std::size_t size) {
  return check_part_size("/descriptions", size, 1);
}

Status check_frame_size(std::size_t size) {
  return check_part_size("/frames", size, frame_layout::kHeaderSize);
}

Error incomplete_recording() {
  return {"incomplete", "", "the recording is incomplete: its end is missing"};
}

Status check_recording_header(std::span<const std::uint8_t> header) {
  if (!is_frame_recording(header)) {
    return Error{"other_format", "", "this is not a recording of frames"};
  }
  if (header.size() < kRecordingHeader) return incomplete_recording();
  ByteReader reader(header.subspan(kFrameRecordingMagic.size()));
  const auto version = reader.get<std::uint32_t>();
  if (version == kRecordingVersion) return {};
  return Error{"other_version", "",
               "the recording has version " + std::to_string(version) +
                   " of its format, and this program reads version " +
                   std::to_string(kRecordingVersion)};
}

}  // namespace

Status RecordingIndex::add_description(std::span<const std::uint8_t> description) {
  if (descriptions_.size() == kMaxRecordedDescriptions) {
    return too_many_parts("/descriptions", " descriptions", kMaxRecordedDescriptions);
  }
  if (Status size = check_description_size(description.size()); !size) return size;
  descriptions_.push_back({static_cast<std::uint32_t>(frames_.size()), end_,
                           static_cast<std::uint32_t>(description.size()), fnv_of(description)});
  end_ += description.size();
  return {};
}

Status RecordingIndex::add_frame(std::span<const std::uint8_t> frame) {
  if (frames_.size() == kMaxRecordedFrames) {
    return too_many_parts("/frames", " frames", kMaxRecordedFrames);
  }
  if (Status size = check_frame_size(frame.size()); !size) return size;
  frames_.push_back({end_, static_cast<std::uint32_t>(frame.size()), is_key_frame(frame)});
  end_ += frame.size();
  return {};
}

void RecordingIndex::truncate(std::size_t count) {
  if (count >= frames_.size()) return;
  frames_.resize(count);
  std::erase_if(descriptions_, [count](const RecordedDescription& description) {
    return description.first_frame >= count;
  });
  place_parts();
}

std::size_t RecordingIndex::key_before(std::size_t frame) const {
  while (frame > 0 && !frames_[frame].is_key) --frame;
  return frame;
}

void RecordingIndex::place_parts() {
  end_ = kRecordingHeader;
  auto description = descriptions_.begin();
  const auto place = [this](auto& part) {
    part.offset = end_;
    end_ += part.size;
  };
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    if (description != descriptions_.end() && description->first_frame == f) place(*description++);
    place(frames_[f]);
  }
}

std::vector<std::uint8_t> write_recording_header() {
  std::vector<std::uint8_t> bytes;
  append_text(bytes, kFrameRecordingMagic);
  ByteWriter(bytes).put(kRecordingVersion);
  return bytes;
}

std::vector<std::uint8_t> write_recording_index(const RecordingIndex& index) {
  std::vector<std::uint8_t> bytes;
  ByteWriter writer(bytes);
  writer.put(static_cast<std::uint32_t>(index.descriptions().size()));
  writer.put(static_cast<std::uint32_t>(index.frames().size()));
  for (const RecordedDescription& description : index.descriptions()) {
    writer.put(description.first_frame);
    writer.put(description.size);
    writer.put(description.check);
  }
  for (const RecordedFrame& frame : index.frames()) {
    writer.put(frame.size | (frame.is_key ? kKeyBit : 0));
  }
  const auto size = static_cast<std::uint32_t>(bytes.size());
  const std::uint32_t check = fnv_of(bytes);
  writer.put(size);
  writer.put(check);
  append_text(bytes, kEndMagic);
  return bytes;
}

Result<RecordingIndex> read_index_content(std::span<const std::uint8_t> content) {
  ByteReader reader(content);
  const std::size_t descriptions = reader.get<std::uint32_t>();
  const std::size_t frames = reader.get<std::uint32_t>();
  if (descriptions == 0 || descriptions > kMaxRecordedDescriptions) {
    return bad_value("/descriptions",
                     "must be from 1 to " + std::to_string(kMaxRecordedDescriptions));
  }
  if (frames == 0 || frames > kMaxRecordedFrames) {
    return bad_value("/frames", "must be from 1 to " + std::to_string(kMaxRecordedFrames));
  }
  if (reader.left() != descriptions * kDescriptionEntry + frames * kFrameEntry) {
    return bad_value("/index", "must have an entry for each description and each frame");
  }
  RecordingIndex index;
  for (std::size_t d = 0; d < descriptions; ++d) {
    const auto first = reader.get<std::uint32_t>();
    const auto size = reader.get<std::uint32_t>();
    if (Status good = check_description_size(size); !good) return good.errors();
    const bool follows =
        d == 0 ? first == 0 : first > index.descriptions_.back().first_frame && first < frames;
    if (!follows) return bad_value("/descriptions", "must be in order, the first at frame 0");
    index.descriptions_.push_back({first, 0, size, reader.get<std::uint32_t>()});
  }
  for (std::size_t f = 0; f < frames; ++f) {
    const auto entry = reader.get<std::uint32_t>();
    const std::uint32_t size = entry & ~kKeyBit;
    if (Status good = check_frame_size(size); !good) return good.errors();
    index.frames_.push_back({0, size, (entry & kKeyBit) != 0});
  }
  const bool have_keys = std::ranges::all_of(
      index.descriptions_,
      [&](const RecordedDescription& one) { return index.frames_[one.first_frame].is_key; });
  if (!have_keys) return bad_value("/frames", "must begin with a key frame in each description");
  index.place_parts();
  return index;
}

Result<RecordingIndex> read_recording_index(std::uint64_t size, const ReadBytes& read) {
  const auto begin =
      read(0, static_cast<std::size_t>(std::min<std::uint64_t>(size, kRecordingHeader)));
  if (!begin) return begin.errors();
  if (Status good = check_recording_header(begin.value()); !good) return good.errors();
  if (size < kRecordingHeader + kEndSize) return incomplete_recording();
  const auto end = read(size - kEndSize, kEndSize);
  if (!end) return end.errors();
  ByteReader reader(end.value());
  const std::size_t index_size = reader.get<std::uint32_t>();
  const auto check = reader.get<std::uint32_t>();
  const bool is_marked = std::equal(kEndMagic.begin(), kEndMagic.end(), end.value().begin() + 8);
  if (!is_marked || index_size > size - kRecordingHeader - kEndSize) return incomplete_recording();
  const auto content = read(size - kEndSize - index_size, index_size);
  if (!content) return content.errors();
  if (fnv_of(content.value()) != check) {
    return Error{"damaged", "/index", "the index of the recording does not match its check"};
  }
  Result<RecordingIndex> index = read_index_content(content.value());
  if (index && index.value().content_end() != size - kEndSize - index_size) {
    return bad_value("", "the sizes in the index must be those of the file");
  }
  return index;
}

bool matches(const RecordedDescription& description, std::span<const std::uint8_t> bytes) {
  return bytes.size() == description.size && fnv_of(bytes) == description.check;
}

bool is_frame_recording(std::span<const std::uint8_t> begin) {
  return begin.size() >= kFrameRecordingMagic.size() &&
         std::ranges::equal(begin.first(kFrameRecordingMagic.size()), kFrameRecordingMagic);
}

}  // namespace vat

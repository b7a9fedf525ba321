#include "protocol/recording/recording_index.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "core/support/byte_io.h"
#include "protocol/frame/grid_frame.h"

// Files of recorded frames. The reader rejects invalid files and names the error.

namespace vat::recording_index_test {
namespace {

using testing::ElementsAre;

using Bytes = std::vector<std::uint8_t>;

/// Bytes of a frame for the index, which reads only the type in the header.
Bytes make_frame(bool is_key, std::size_t size) {
  Bytes bytes(size, 7);
  bytes.at(5) = is_key ? 1 : 2;
  return bytes;
}

Bytes bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

/// A file that is composed in memory.
class File {
 public:
  File& description(std::string_view text) {
    EXPECT_TRUE(index.add_description(bytes_of(text)).ok());
    return append(bytes_of(text));
  }
  File& frame(bool is_key, std::size_t size = 60) {
    const Bytes bytes = make_frame(is_key, size);
    EXPECT_TRUE(index.add_frame(bytes).ok());
    return append(bytes);
  }
  Bytes finished() const {
    Bytes all = content;
    const Bytes end = write_recording_index(index);
    all.insert(all.end(), end.begin(), end.end());
    return all;
  }

  RecordingIndex index;
  Bytes content = write_recording_header();

 private:
  File& append(const Bytes& bytes) {
    content.insert(content.end(), bytes.begin(), bytes.end());
    return *this;
  }
};

File make_file() {
  File file;
  file.description("{\"epoch\":1}").frame(true).frame(false, 61).frame(true, 62);
  file.description("{\"epoch\":2}").frame(true).frame(false);
  return file;
}

Result<RecordingIndex> read(const Bytes& bytes) {
  return read_recording_index(
      bytes.size(), [&bytes](std::uint64_t offset, std::size_t length) -> Result<Bytes> {
        EXPECT_LE(offset + length, bytes.size());
        const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(offset);
        return Bytes(begin, begin + static_cast<std::ptrdiff_t>(length));
      });
}

std::string code_of(const Bytes& bytes) {
  const Result<RecordingIndex> index = read(bytes);
  return index ? "" : index.errors()[0].code;
}

TEST(RecordingIndex, IsReadUnchanged) {
  const File file = make_file();
  const Bytes bytes = file.finished();
  const Result<RecordingIndex> index = read(bytes);
  ASSERT_TRUE(index.ok()) << index.errors()[0].message;
  EXPECT_EQ(index.value().frames(), file.index.frames());
  EXPECT_EQ(index.value().descriptions(), file.index.descriptions());
  EXPECT_EQ(index.value().content_end(), file.content.size());
  const RecordedDescription& second = index.value().descriptions().at(1);
  EXPECT_EQ(second.first_frame, 3U);
  const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(second.offset);
  EXPECT_TRUE(matches(second, Bytes(begin, begin + second.size)));
  EXPECT_FALSE(matches(second, bytes_of("{\"epoch\":3}")));
}

TEST(RecordingIndex, FindsTheKeyFrameBefore) {
  const RecordingIndex index = make_file().index;
  std::vector<std::size_t> keys;
  for (std::size_t f = 0; f < 5; ++f) keys.push_back(index.key_before(f));
  EXPECT_THAT(keys, ElementsAre(0, 0, 2, 3, 3));
}

TEST(RecordingIndex, TruncatedIsTheIndexOfTheFirstFrames) {
  File shorter;
  shorter.description("{\"epoch\":1}").frame(true).frame(false, 61).frame(true, 62);
  for (const std::size_t count : {3U, 4U}) {
    RecordingIndex index = make_file().index;
    index.truncate(count);
    if (count == 4) shorter.description("{\"epoch\":2}").frame(true);
    EXPECT_EQ(index.frames(), shorter.index.frames());
    EXPECT_EQ(index.descriptions(), shorter.index.descriptions());
    EXPECT_EQ(index.content_end(), shorter.index.content_end());
  }
}

TEST(RecordingIndex, CutAnywhereIsRefused) {
  const Bytes bytes = make_file().finished();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    const std::string code = code_of(cut);
    const std::string expected = length < 8 ? "other_format" : "incomplete";
    ASSERT_EQ(code, expected) << length;
  }
}

TEST(RecordingIndex, DamagedIsRefused) {
  const File file = make_file();
  Bytes bytes = file.finished();
  const auto code_at = [&bytes](std::size_t at) {
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 16);
    const std::string code = code_of(bytes);
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 16);
    return code;
  };
  for (std::size_t at = 0; at < 8; ++at) ASSERT_EQ(code_at(at), "other_format") << at;
  for (std::size_t at = 8; at < 12; ++at) ASSERT_EQ(code_at(at), "other_version") << at;
  for (std::size_t at = file.content.size(); at < bytes.size() - 16; ++at) {
    ASSERT_EQ(code_at(at), "damaged") << at;
  }
  for (std::size_t at = bytes.size() - 16; at < bytes.size(); ++at) {
    ASSERT_THAT(code_at(at), testing::AnyOf("damaged", "incomplete")) << at;
  }
  bytes.insert(bytes.begin() + 20, 0);
  EXPECT_EQ(code_of(bytes), "bad_value");  // longer than its index states
}

/// Returns the code for the file with one changed number of its index and a matching check.
std::string code_with(std::size_t at, std::uint32_t value) {
  const File file = make_file();
  Bytes bytes = file.finished();
  store(bytes, file.content.size() + at, value);
  // An index of its own bytes yields the check.
  std::uint32_t check = 2'166'136'261;
  for (std::size_t i = file.content.size(); i < bytes.size() - 16; ++i) {
    check = (check ^ bytes[i]) * 16'777'619;
  }
  store(bytes, bytes.size() - 12, check);
  return code_of(bytes);
}

TEST(RecordingIndex, ValuesOutOfRangeAreRefused) {
  ASSERT_EQ(code_with(0, 2), "");
  EXPECT_EQ(code_with(0, 0), "bad_value");  // descriptions
  EXPECT_EQ(code_with(0, 10'001), "bad_value");
  EXPECT_EQ(code_with(4, 0), "bad_value");  // frames
  EXPECT_EQ(code_with(4, 4), "bad_value");
  EXPECT_EQ(code_with(4, 0xffff'ffff), "bad_value");
  EXPECT_EQ(code_with(8, 1), "bad_value");   // first frame of the first description
  EXPECT_EQ(code_with(12, 0), "bad_value");  // its size
  EXPECT_EQ(code_with(12, 0xffff'ffff), "bad_value");
  EXPECT_EQ(code_with(12, 12), "bad_value");           // longer than the file
  EXPECT_EQ(code_with(20, 0), "bad_value");            // first frame of the second description
  EXPECT_EQ(code_with(20, 4), "bad_value");            // not a key frame
  EXPECT_EQ(code_with(20, 5), "bad_value");            // after the last frame
  EXPECT_EQ(code_with(32, 0x8000'0000), "bad_value");  // size of a frame
  EXPECT_EQ(code_with(32, 0x8000'0033), "bad_value");
  EXPECT_EQ(code_with(32, 60), "bad_value");  // the first frame is not a key frame
  EXPECT_EQ(code_with(32, 0x8000'003c), "");
}

TEST(RecordingIndex, PartsBeyondTheLimitsAreRefused) {
  RecordingIndex index;
  EXPECT_FALSE(index.add_description({}).ok());
  EXPECT_FALSE(index.add_frame({}).ok());
  const Bytes description(1);
  for (std::size_t d = 0; d < kMaxRecordedDescriptions; ++d) {
    ASSERT_TRUE(index.add_description(description).ok());
  }
  EXPECT_EQ(index.add_description(description).errors()[0].code, "too_large");
  EXPECT_FALSE(index.add_frame(Bytes(51)).ok());
  const Bytes frame = make_frame(true, 52);
  for (std::size_t f = 0; f < kMaxRecordedFrames; ++f) ASSERT_TRUE(index.add_frame(frame).ok());
  EXPECT_EQ(index.add_frame(frame).errors()[0].code, "too_large");
}

Bytes read_golden(const std::string& name) {
  std::ifstream file(VAT_SOURCE_DIR "/tests/golden/" + name, std::ios::binary);
  EXPECT_TRUE(file) << name;
  return Bytes{std::istreambuf_iterator<char>(file), {}};
}

// The file is read by the tests of the viewer too.
TEST(RecordingIndex, WritesTheDocumentedBytes) {
  const Bytes key = read_golden("frames/v2-twice.bin");
  const Bytes delta = read_golden("frames/v2-twice-one.bin");
  const Bytes description = read_golden("frame_recordings/twice.json");
  RecordingIndex index;
  Bytes bytes = write_recording_header();
  const auto append = [&bytes](const Bytes& part) {
    bytes.insert(bytes.end(), part.begin(), part.end());
  };
  ASSERT_TRUE(index.add_description(description).ok());
  append(description);
  for (const Bytes* frame : {&key, &delta, &key, &delta}) {
    ASSERT_TRUE(index.add_frame(*frame).ok());
    append(*frame);
  }
  append(write_recording_index(index));
  if (std::getenv("VAT_UPDATE_GOLDEN") != nullptr) {  // NOLINT(concurrency-mt-unsafe)
    std::ofstream(VAT_SOURCE_DIR "/tests/golden/frame_recordings/twice.vatrec", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  EXPECT_EQ(bytes, read_golden("frame_recordings/twice.vatrec"));
}

}  // namespace
}  // namespace vat::recording_index_test

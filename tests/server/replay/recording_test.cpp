#include "server/history/recording.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/saved/sealed_bytes.h"
#include "core/support/byte_io.h"

// Files of recordings. The reader rejects invalid files and names the error.

namespace vat::recording_test {
namespace {

Recording make_recording() {
  Recording recording;
  recording.program = "0.1.0";
  recording.name = "first";
  recording.end = 30;
  recording.log = {{1, 0, 0, 0, "scene.load", R"({"scene":{}})", false},
                   {2, 0, 0, 1, "control.play", "{}", false},
                   {3, 12, 12, 1, "world.set_gravity", R"({"gravity":[0,0,1]})", true},
                   {4, 20, 3, 2, "leave", "{}", false}};
  recording.moments = {{10, 2, "{}", {1, 2, 3}}, {20, 3, "{}", {}}};
  recording.hashes = {{10, 2, 77}, {30, 4, 99}};
  return recording;
}

std::string code_of(std::span<const std::uint8_t> bytes) {
  const Result<Recording> recording = read_recording(bytes);
  return recording ? "" : recording.errors()[0].code;
}

/// Returns the path of the first error of a recording.
std::string place_of(const Recording& recording) {
  const Result<Recording> read = read_recording(write_recording(recording));
  if (read) return "none";
  EXPECT_EQ(read.errors()[0].code, "bad_value");
  return read.errors()[0].path;
}

TEST(RecordingFile, IsReadUnchanged) {
  const Recording recording = make_recording();
  const Result<Recording> read = read_recording(write_recording(recording));
  ASSERT_TRUE(read.ok()) << read.errors()[0].message;
  EXPECT_EQ(read.value().program, recording.program);
  EXPECT_EQ(read.value().instructions, recording.instructions);
  EXPECT_EQ(read.value().name, recording.name);
  EXPECT_EQ(read.value().end, recording.end);
  ASSERT_EQ(read.value().log.size(), recording.log.size());
  EXPECT_EQ(read.value().log[2].params, recording.log[2].params);
  EXPECT_TRUE(read.value().log[2].refused);
  EXPECT_EQ(read.value().log[3].participant, 2U);
  ASSERT_EQ(read.value().moments.size(), 2U);
  EXPECT_EQ(read.value().moments[0].state, recording.moments[0].state);
  ASSERT_EQ(read.value().hashes.size(), 2U);
  EXPECT_EQ(read.value().hashes[1].hash, 99U);
  EXPECT_EQ(write_recording(read.value()), write_recording(recording));
}

TEST(RecordingFile, CutAnywhereIsRefused) {
  const std::vector<std::uint8_t> bytes = write_recording(make_recording());
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::string expected = length < kSealSize ? "other_format" : "wrong_length";
    ASSERT_EQ(code_of(std::span(bytes).first(length)), expected) << length;
    if (length < kSealSize) continue;
    std::vector<std::uint8_t> cut(bytes.begin(),
                                  bytes.begin() + static_cast<std::ptrdiff_t>(length));
    close_seal(cut);
    ASSERT_EQ(code_of(cut), "bad_value") << length;
  }
}

TEST(RecordingFile, DamagedOrLongerOrNewerIsRefused) {
  std::vector<std::uint8_t> bytes = write_recording(make_recording());
  for (std::size_t at = kSealSize; at < bytes.size(); ++at) {
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 16);
    ASSERT_EQ(code_of(bytes), "damaged") << at;
    bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 16);
  }
  std::vector<std::uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(code_of(longer), "wrong_length");
  close_seal(longer);
  EXPECT_EQ(code_of(longer), "bad_value");
  store<std::uint32_t>(bytes, kSealVersionAt, 2);
  EXPECT_EQ(code_of(bytes), "other_version");
}

TEST(RecordingFile, WithPartsOutOfOrderIsRefused) {
  const auto place_after = [](const std::function<void(Recording&)>& change) {
    Recording recording = make_recording();
    change(recording);
    return place_of(recording);
  };
  EXPECT_EQ(place_after([](Recording&) {}), "none");
  EXPECT_EQ(place_after([](Recording& r) { r.log[3].sequence = 6; }), "/log");
  EXPECT_EQ(place_after([](Recording& r) { r.log[3].position = 11; }), "/log");
  EXPECT_EQ(place_after([](Recording& r) { r.log.clear(); }), "/log");
  EXPECT_EQ(place_after([](Recording& r) { r.end = 19; }), "/end");
  EXPECT_EQ(place_after([](Recording& r) { std::swap(r.moments[0], r.moments[1]); }), "/moments");
  EXPECT_EQ(place_after([](Recording& r) { r.hashes[1].position = 31; }), "/hashes");
  EXPECT_EQ(place_after([](Recording& r) { r.hashes[1].sequence = 5; }), "/hashes");
}

// A log without its older entries needs a moment at which it starts.
TEST(RecordingFile, OfAShortenedLogBeginsAtItsFirstMoment) {
  Recording recording = make_recording();
  recording.log.erase(recording.log.begin() + 1, recording.log.begin() + 3);
  recording.begin = 20;
  recording.moments.erase(recording.moments.begin());
  recording.hashes.erase(recording.hashes.begin());
  EXPECT_FALSE(recording.is_whole());
  EXPECT_EQ(place_of(recording), "none");
  recording.moments[0].sequence = 2;
  EXPECT_EQ(place_of(recording), "/moments");
  recording.moments.clear();
  EXPECT_EQ(place_of(recording), "/moments");
}

}  // namespace
}  // namespace vat::recording_test

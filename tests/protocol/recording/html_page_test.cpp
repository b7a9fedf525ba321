#include "protocol/recording/html_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "protocol/json/json_reader.h"
#include "protocol/recording/recording_index.h"
#include "tests/support/temporary_folder.h"

// Pages with a recording. The tests of the viewer restore the data; here, a second decoder does.

namespace vat::test::html_page_test {
namespace {

using testing::HasSubstr;

using Bytes = std::vector<std::uint8_t>;

constexpr const char* kRecording = VAT_SOURCE_DIR "/tests/golden/frame_recordings/twice.vatrec";

/// Inserts carriage returns as a page does.
void restore(std::span<std::uint8_t> bytes, const Bytes& marks) {
  std::size_t mark = 0;
  for (std::uint8_t& byte : bytes) {
    if (byte != '\n') continue;
    if ((marks.at(mark / 8) >> (mark % 8) & 1) != 0) byte = '\r';
    ++mark;
  }
}

Bytes from_hex(const std::string& digits) {
  Bytes bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

Bytes restored(Bytes data, MarkLevels levels) {
  Bytes above = from_hex(levels.last);
  for (auto level = levels.levels.rbegin(); level != levels.levels.rend(); ++level) {
    restore(*level, above);
    above = *level;
  }
  restore(data, above);
  return data;
}

/// Bytes with all values, in an order without a short period.
Bytes make_data(std::size_t count) {
  Bytes data;
  std::uint32_t state = 1;
  for (std::size_t i = 0; i < count; ++i) {
    state = state * 1'664'525 + 1'013'904'223;
    data.push_back(static_cast<std::uint8_t>(state >> 24));
  }
  return data;
}

TEST(LineMarks, RestoreTheData) {
  for (const std::size_t count : {0U, 1U, 1000U, 300'000U, 3'000'000U}) {
    const Bytes data = make_data(count);
    Bytes text = data;
    LineMarks marks;
    const std::size_t half = count / 2;
    marks.replace(std::span(text).first(half));
    marks.replace(std::span(text).subspan(half));
    EXPECT_EQ(std::ranges::count(text, '\r'), 0);
    const MarkLevels levels = make_mark_levels(marks.marks());
    std::size_t size = levels.last.size();
    for (const Bytes& level : levels.levels) {
      EXPECT_EQ(std::ranges::count(level, '\r'), 0);
      size += level.size();
    }
    EXPECT_EQ(restored(text, levels), data) << count;
    EXPECT_LE(size, 200 + count / 1000) << count;
  }
}

class HtmlPageTest : public testing::Test {
 protected:
  HtmlPageTest() {
    folder.write("web/export/page.html",
                 "<title>@TITLE@</title><script>@PARTS@</script><plaintext>");
    folder.write("web/export/player.js.gz", "a\rprogram\n");
  }
  Status write(const std::string& recording) const {
    return write_html_page(recording, page, folder.file("web"));
  }
  static std::string read(const std::string& name) {
    std::ifstream file(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  TemporaryFolder folder;
  const std::string page = folder.file("page.html");
};

TEST_F(HtmlPageTest, ContainsProgramAndRecording) {
  const Status written = write(kRecording);
  ASSERT_TRUE(written.ok()) << written.errors()[0].message;
  const std::string text = read(page);
  EXPECT_THAT(text, testing::StartsWith("<title>Two particles</title><script>{"));
  const std::size_t begin = text.find('{');
  const std::size_t end = text.find("}</script>") + 1;
  const Json parts = Json::parse(text.substr(begin, end - begin));
  EXPECT_EQ(parts.at("program"), 10);
  const std::string recording = read(kRecording);
  EXPECT_EQ(parts.at("recording"), recording.size());
  const std::string expected = "a\rprogram\n" + recording;
  const std::size_t at = text.find("<plaintext>") + 11;
  EXPECT_EQ(parts.at("marks"), Json::array());
  ASSERT_EQ(text.size() - at, expected.size());
  Bytes data(text.begin() + static_cast<std::ptrdiff_t>(at), text.end());
  restore(data, from_hex(parts.at("last")));
  EXPECT_EQ(std::string(data.begin(), data.end()), expected);
}

/// Returns a recording with a title.
std::string recording_with(const std::string& title) {
  const std::string description = Json{{"title", title}}.dump();
  Bytes frame(52);
  frame[5] = 1;
  RecordingIndex index;
  EXPECT_TRUE(index.add_description(Bytes(description.begin(), description.end())).ok());
  EXPECT_TRUE(index.add_frame(frame).ok());
  const Bytes begin = write_recording_header();
  const Bytes end = write_recording_index(index);
  return std::string(begin.begin(), begin.end()) + description +
         std::string(frame.begin(), frame.end()) + std::string(end.begin(), end.end());
}

TEST_F(HtmlPageTest, TitleIsTextInAscii) {
  folder.write("a.vatrec", recording_with("<b>\xc3\xbc & \xe2\x82\xac \xf0\x9f\x92\xa7"));
  ASSERT_TRUE(write(folder.file("a.vatrec")).ok());
  EXPECT_THAT(read(page),
              testing::StartsWith("<title>&#60;b>&#252; &#38; &#8364; &#128167;</title>"));
}

TEST_F(HtmlPageTest, FaultsAreExplained) {
  folder.write("commands.vatrec", "vat.rec\n");
  EXPECT_THAT(write(folder.file("commands.vatrec")).errors()[0].message, HasSubstr("vat replay"));
  folder.write("web/export/page.html", "<title>@TITLE@</title>");
  EXPECT_THAT(write(kRecording).errors()[0].message, HasSubstr("build the viewer again"));
  std::filesystem::remove(folder.file("web/export/page.html"));
  EXPECT_THAT(write(kRecording).errors()[0].message, HasSubstr("./vat prepare export"));
  EXPECT_FALSE(std::filesystem::exists(page));
}

}  // namespace
}  // namespace vat::test::html_page_test

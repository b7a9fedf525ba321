#include "protocol/recording/html_page.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "protocol/files/output_file.h"
#include "protocol/json/json_reader.h"
#include "protocol/recording/recording_file.h"

namespace vat {
namespace {

constexpr std::uint64_t kPartBytes = std::uint64_t{1} << 20;  // read at once
constexpr std::size_t kMaxLastMarks = 64;                     // [bytes]
constexpr std::string_view kTitleMark = "@TITLE@";
constexpr std::string_view kPartsMark = "@PARTS@";

Result<std::string> read_whole(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  if (!file) {
    return Error{"io_error", name, "cannot be read; the viewer is built by ./vat prepare export"};
  }
  return std::string{std::istreambuf_iterator<char>(file), {}};
}

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Passes program and recording in parts to `use`.
template <class Use>
Status for_each_part(const std::string& program, RecordingFile& recording, const Use& use) {
  if (Status used = use({program.begin(), program.end()}); !used) return used;
  for (std::uint64_t at = 0; at < recording.size(); at += kPartBytes) {
    auto part =
        recording.read(at, static_cast<std::size_t>(std::min(kPartBytes, recording.size() - at)));
    if (!part) return part.errors();
    if (Status used = use(std::move(part).value()); !used) return used;
  }
  return {};
}

/// Returns a UTF-8 text in HTML, in ASCII.
std::string html_text(const std::string& text) {
  std::string escaped;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<std::uint8_t>(text[i]);
    if (byte < 0x80 && byte != '<' && byte != '&') {
      escaped += text[i];
      continue;
    }
    const int rest = byte < 0xc0 ? 0 : byte < 0xe0 ? 1 : byte < 0xf0 ? 2 : 3;  // further bytes
    std::uint32_t code = byte < 0x80 ? byte : byte & (0x3fU >> rest);
    for (int r = 0; r < rest && i + 1 < text.size(); ++r) {
      code = code << 6 | (static_cast<std::uint8_t>(text[++i]) & 0x3fU);
    }
    escaped += "&#" + std::to_string(code) + ';';
  }
  return escaped;
}

Result<std::string> title_of(RecordingFile& recording, const std::string& name) {
  const Result<std::string> text = recording.description(0);
  if (!text) return text.errors();
  const Result<Json> json = parse_json(text.value(), {text.value().size(), 16, kMaxRecordedBytes});
  if (!json || !json.value().is_object()) {
    return Error{"bad_value", name, "the description must be a JSON object"};
  }
  const auto title = json.value().find("title");
  const bool has_title = title != json.value().end() && title->is_string() && *title != "";
  return has_title ? title->get<std::string>() : std::string("vat");
}

Status insert_value(std::string& page, std::string_view mark, const std::string& text,
                    const std::string& name) {
  const std::size_t at = page.find(mark);
  if (at == std::string::npos) {
    return Error{"bad_value", name, "has no " + std::string(mark) + "; build the viewer again"};
  }
  page.replace(at, mark.size(), text);
  return {};
}

std::string parts_text(std::size_t program, std::uint64_t recording, const MarkLevels& marks) {
  Json sizes = Json::array();
  for (const auto& level : marks.levels) sizes.push_back(level.size());
  return Json{{"program", program},
              {"recording", recording},
              {"marks", std::move(sizes)},
              {"last", marks.last}}
      .dump();
}

}  // namespace

void LineMarks::replace(std::span<std::uint8_t> bytes) {
  for (std::uint8_t& byte : bytes) {
    if (byte != '\n' && byte != '\r') continue;
    if (count_ % 8 == 0) marks_.push_back(0);
    if (byte == '\r') {
      marks_.back() = static_cast<std::uint8_t>(marks_.back() | (1U << (count_ % 8)));
    }
    byte = '\n';
    ++count_;
  }
}

MarkLevels make_mark_levels(std::vector<std::uint8_t> marks) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  MarkLevels made;
  while (marks.size() > kMaxLastMarks) {
    LineMarks next;
    next.replace(marks);
    made.levels.push_back(std::move(marks));
    marks = next.marks();
  }
  for (const std::uint8_t byte : marks) {
    made.last += kDigits[byte >> 4];
    made.last += kDigits[byte & 15];
  }
  return made;
}

Status write_html_page(const std::string& recording, const std::string& page,
                       const std::string& web_folder) {
  const std::string folder = web_folder + "/export/";
  Result<std::string> shell = read_whole(folder + "page.html");
  if (!shell) return shell.errors();
  const Result<std::string> program = read_whole(folder + "player.js.gz");
  if (!program) return program.errors();
  Result<RecordingFile> file = RecordingFile::open(recording);
  if (!file) return file.errors();
  const Result<std::string> title = title_of(file.value(), recording);
  if (!title) return title.errors();
  LineMarks marks;
  const auto mark = [&](std::vector<std::uint8_t> part) -> Status {
    marks.replace(part);
    return {};
  };
  if (Status read = for_each_part(program.value(), file.value(), mark); !read) return read;
  const MarkLevels levels = make_mark_levels(marks.marks());
  std::string& text = shell.value();
  const std::string parts = parts_text(program.value().size(), file.value().size(), levels);
  for (const auto& [place, value] :
       {std::pair(kTitleMark, html_text(title.value())), std::pair(kPartsMark, parts)}) {
    if (Status done = insert_value(text, place, value, folder + "page.html"); !done) return done;
  }
  Result<OutputFile> output = OutputFile::create(page);
  if (!output) return output.errors();
  if (Status written = output.value().append(text); !written) return written;
  const auto write = [&](std::vector<std::uint8_t> part) -> Status {
    LineMarks().replace(part);
    return output.value().append(text_of(part));
  };
  if (Status written = for_each_part(program.value(), file.value(), write); !written) {
    return written;
  }
  for (const std::vector<std::uint8_t>& level : levels.levels) {
    if (Status written = output.value().append(text_of(level)); !written) return written;
  }
  return output.value().commit();
}

}  // namespace vat

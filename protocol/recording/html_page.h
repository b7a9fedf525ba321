#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/support/result.h"

namespace vat {

/// Bytes in a page that a browser returns unchanged. The page has the encoding windows-1252, so
/// that each byte is one character. The HTML parser changes only carriage returns, to line feeds.
/// The page therefore contains line feeds instead of carriage returns, and marks: one bit for each
/// line feed, 1 for a carriage return, beginning with the lowest bit of the first byte. The marks
/// need 0.1 % of the data.
class LineMarks {
 public:
  /// Replaces carriage returns in the next bytes of the data.
  void replace(std::span<std::uint8_t> bytes);
  /// Returns the marks of all bytes so far.
  const std::vector<std::uint8_t>& marks() const { return marks_; }

 private:
  std::vector<std::uint8_t> marks_;
  std::size_t count_ = 0;
};

/// Marks in a page after the data: marks contain carriage returns too, and have marks themselves.
struct MarkLevels {
  std::vector<std::vector<std::uint8_t>> levels;  ///< without carriage returns
  std::string last;                               ///< marks of the last level in hexadecimal digits
};
MarkLevels make_mark_levels(std::vector<std::uint8_t> marks);

/// Writes the page `page` with the recording `recording`. The folder `web_folder` contains the
/// built viewer. The path of an error is the name of the file.
Status write_html_page(const std::string& recording, const std::string& page,
                       const std::string& web_folder);

}  // namespace vat

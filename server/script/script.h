#pragma once

#include <string>
#include <vector>

#include "server/script/pattern.h"

namespace vat::script {

/// Line of a script, with its location.
struct Line {
  std::string place;  ///< "file:line"
  Json action;
};

/// Returns the lines of a `.jsonl` script. Skips blank lines. Throws ScriptError for a line that is
/// not a JSON object.
std::vector<Line> read_script(const std::string& path);

/// Returns the lines of the first code block after the line `heading` of a Markdown document. A
/// block ```jsonl contains lines of a script. A block ```text contains an exchange of messages: a
/// connected client sends the lines with "> ", and the lines with "< " must match the received
/// messages.
std::vector<Line> read_document(const std::string& path, const std::string& heading);

}  // namespace vat::script

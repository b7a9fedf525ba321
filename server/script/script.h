#pragma once

#include <string>
#include <vector>

#include "server/script/pattern.h"

namespace vat::script {

/// A line of a script, with its location.
struct Line {
  std::string place;  ///< "file:line"
  Json action;
};

/// Reads a `.jsonl` script. Skips blank lines. Throws ScriptError with the line that is not a JSON
/// object.
std::vector<Line> read_script(const std::string& path);

/// Reads the first block after the line `heading` of a Markdown document that is fenced with
/// ```jsonl (lines of a script) or with ```text (an exchange; lines with "> " are sent by a
/// connected client, lines with "< " must match what it receives).
std::vector<Line> read_document(const std::string& path, const std::string& heading);

}  // namespace vat::script

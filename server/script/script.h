#pragma once

#include <string>
#include <vector>

#include "server/script/pattern.h"

namespace vat::script {

/// One line of a script, with its place.
struct Line {
  std::string place;  ///< "file:line"
  Json action;
};

/// The lines of a `.jsonl` script; blank lines are skipped. Throws ScriptError, which names the
/// line, where one is not a JSON object.
std::vector<Line> read_script(const std::string& path);

/// What a Markdown document shows after the line `heading`: the first block that is fenced with
/// ```jsonl, the lines of a script, or with ```text, an exchange whose lines begin with "> " (a
/// client, which is connected first, sends) or "< " (it receives what matches).
std::vector<Line> read_document(const std::string& path, const std::string& heading);

}  // namespace vat::script

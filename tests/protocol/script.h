#pragma once

#include <string>
#include <vector>

#include "tests/protocol/pattern.h"

namespace vat::script {

/// One line of a script, with its place.
struct Line {
  std::string place;  ///< "file:line"
  Json action;
};

/// The lines of a `.jsonl` script; blank lines are skipped. Throws ScriptError, which names the
/// line, where one is not a JSON object.
std::vector<Line> read_script(const std::string& path);

/// The exchange that a Markdown document shows: the first block after `heading` that is fenced with
/// ```text; its lines begin with "> " (a client sends) or "< " (it receives what matches).
std::vector<Line> read_exchange(const std::string& path, const std::string& heading);

}  // namespace vat::script

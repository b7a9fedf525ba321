#include "tests/protocol/script.h"

#include <fstream>

namespace vat::script {
namespace {

std::ifstream open(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw ScriptError(path + ": cannot be read");
  return file;
}

Json parse_line(const std::string& text, const std::string& place) {
  Json value = Json::parse(text, nullptr, false);
  if (!value.is_object()) throw ScriptError(place + ": is not a JSON object");
  return value;
}

/// The file without its folders: the name in messages.
std::string short_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

}  // namespace

std::vector<Line> read_script(const std::string& path) {
  std::ifstream file = open(path);
  std::vector<Line> lines;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    if (text.empty()) continue;
    const std::string place = short_name(path) + ':' + std::to_string(number);
    lines.push_back({place, parse_line(text, place)});
  }
  if (lines.empty()) throw ScriptError(path + ": has no lines");
  return lines;
}

std::vector<Line> read_exchange(const std::string& path, const std::string& heading) {
  std::ifstream file = open(path);
  std::vector<Line> lines;
  std::string text;
  bool after_heading = false;
  bool inside = false;
  for (int number = 1; std::getline(file, text); ++number) {
    const std::string place = short_name(path) + ':' + std::to_string(number);
    if (inside) {
      if (text == "```") break;
      if (text.size() < 2 || (text[0] != '>' && text[0] != '<') || text[1] != ' ') {
        throw ScriptError(place + ": must begin with \"> \" or \"< \"");
      }
      const Json message = parse_line(text.substr(2), place);
      lines.push_back({place, {{text[0] == '>' ? "send" : "expect", message}}});
    } else if (text == heading) {
      after_heading = true;
    } else if (after_heading && text == "```text") {
      inside = true;
    }
  }
  if (lines.empty()) throw ScriptError(path + ": has no exchange after \"" + heading + '"');
  return lines;
}

}  // namespace vat::script

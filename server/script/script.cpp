#include "server/script/script.h"

#include <filesystem>
#include <fstream>

namespace vat::script {
namespace {

std::ifstream open(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw ScriptError(path + ": cannot be read");
  if (std::filesystem::is_directory(path)) throw ScriptError(path + ": is a folder");
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

/// A line of an exchange as one of a script.
Line read_exchanged(const std::string& text, const std::string& place) {
  if (text.size() < 2 || (text[0] != '>' && text[0] != '<') || text[1] != ' ') {
    throw ScriptError(place + ": must begin with \"> \" or \"< \"");
  }
  const Json message = parse_line(text.substr(2), place);
  return {place, {{text[0] == '>' ? "send" : "expect", message}}};
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

std::vector<Line> read_document(const std::string& path, const std::string& heading) {
  enum class Place { before, after_heading, in_exchange, in_script };
  std::ifstream file = open(path);
  std::vector<Line> lines;
  std::string text;
  Place where = Place::before;
  for (int number = 1; std::getline(file, text); ++number) {
    const std::string place = short_name(path) + ':' + std::to_string(number);
    if (where == Place::before) {
      if (text == heading) where = Place::after_heading;
    } else if (where == Place::after_heading) {
      if (text == "```jsonl") where = Place::in_script;
      if (text == "```text") {
        where = Place::in_exchange;
        lines.push_back({place, {{"connect", "a"}}});
      }
    } else if (text == "```") {
      break;
    } else {
      lines.push_back(where == Place::in_script ? Line{place, parse_line(text, place)}
                                                : read_exchanged(text, place));
    }
  }
  if (lines.empty()) throw ScriptError(path + ": shows no script after \"" + heading + '"');
  return lines;
}

}  // namespace vat::script

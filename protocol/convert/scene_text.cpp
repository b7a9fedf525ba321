#include <algorithm>

#include "protocol/convert/splishsplash.h"

namespace vat {
namespace {

constexpr std::size_t kLineWidth = 100;

void append_text(const Json& value, std::size_t indent, std::string& text);

/// Appends a list with as many elements in a line as have room.
void append_list(const Json& list, std::size_t indent, std::string& text) {
  const std::string begin = '\n' + std::string(indent + 1, ' ');
  std::size_t line = text.rfind('\n') + 1;
  text += '[';
  bool is_first = true;
  for (const Json& element : list) {
    if (!is_first) text += ',';
    const std::string next = element.dump();
    if (!is_first && text.size() - line + next.size() > kLineWidth) {
      line = text.size() + 1;
      text += begin;
    }
    is_first = false;
    if (element.is_object()) {
      append_text(element, indent + 1, text);
      line = text.rfind('\n') + 1;
    } else {
      text += next;
    }
  }
  text += ']';
}

void append_text(const Json& value, std::size_t indent, std::string& text) {
  const std::string line = value.dump();
  if (!value.is_structured() || indent + line.size() <= kLineWidth) {
    text += line;
    return;
  }
  if (value.is_array()) return append_list(value, indent, text);
  const std::string begin = '\n' + std::string(indent + 2, ' ');
  text += '{';
  bool is_first = true;
  for (const auto& [key, element] : value.items()) {
    if (!is_first) text += ',';
    is_first = false;
    text += begin + Json(key).dump() + ": ";
    append_text(element, indent + 2, text);
  }
  text += '\n' + std::string(indent, ' ') + '}';
}

}  // namespace

std::string scene_text(const Json& document) {
  std::string text;
  append_text(document, 0, text);
  return text + '\n';
}

}  // namespace vat

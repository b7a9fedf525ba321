#include "server/replay/foreign_text.h"

#include "protocol/json/json_reader.h"
#include "protocol/json/printable.h"

namespace vat {
namespace {

bool is_utf8(const std::string& text) {
  try {
    return !Json(text).dump().empty();
  } catch (const Json::exception&) {
    return false;
  }
}

}  // namespace

std::string fit_to_tell(const std::string& text, std::size_t most) {
  return text.size() <= most && is_utf8(text) ? text : printable(text.substr(0, most));
}

}  // namespace vat

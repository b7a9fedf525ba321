#include "protocol/scene/part_names.h"

#include <map>

#include "protocol/json/json_reader.h"

namespace vat {

void find_repeated_names(std::span<const NamedPart> parts, std::string_view list, Errors& errors) {
  std::map<std::string_view, bool> seen;  // whether the scene has a part with this name
  for (const NamedPart& part : parts) {
    if (part.name.empty()) continue;
    const auto [earlier, is_new] = seen.try_emplace(part.name, part.is_in_scene);
    if (is_new) continue;
    if (!part.is_in_scene || !earlier->second) {
      add_error(errors, "duplicate", pointer_to(pointer_to("", list), part.at) + "/name",
                "must not be the name of an earlier element of this list");
    }
    earlier->second = earlier->second || part.is_in_scene;
  }
}

}  // namespace vat

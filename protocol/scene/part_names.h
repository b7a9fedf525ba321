#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "core/support/result.h"

namespace vat {

/// Named element of a list of a scene document.
struct NamedPart {
  std::size_t at = 0;       ///< index in the list
  std::string name;         ///< empty: the name is invalid
  bool is_in_scene = true;  ///< false: the part has read errors, so the core does not check it
};

/// Adds an error for each part whose name an earlier part has, if the core does not see both parts.
/// `list` is the name of the list.
void find_repeated_names(std::span<const NamedPart> parts, std::string_view list, Errors& errors);

}  // namespace vat

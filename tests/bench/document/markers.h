#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/support/result.h"

/// Pages that people write and programs fill: what stands between the lines `<!-- begin NAME -->`
/// and `<!-- end NAME -->` is made by a program, all else by a person.
namespace vat::bench {

/// The page with `contents[NAME]` between the lines of each NAME. An error for each name that only
/// one of page and contents has, that comes twice, or whose lines are not in pairs.
Result<std::string> fill_markers(const std::string& page,
                                 const std::map<std::string, std::string>& contents);

/// Returns whether the page has the line `<!-- begin NAME -->`.
bool has_marker(const std::string& page, const std::string& name);

/// The targets of the page's pictures, `![...](TARGET)`, each once, in their order.
std::vector<std::string> pictures_of(const std::string& page);

}  // namespace vat::bench

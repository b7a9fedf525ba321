#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/support/result.h"

/// Pages with generated parts. A program writes the text between the lines `<!-- begin NAME -->`
/// and `<!-- end NAME -->`. People write the rest.
namespace vat::bench {

/// Returns the page with `contents[NAME]` between the lines of each NAME. Fails for each name that
/// is missing in the page or the contents, occurs twice, or has unpaired lines.
Result<std::string> fill_markers(const std::string& page,
                                 const std::map<std::string, std::string>& contents);

/// Returns whether the page has the line `<!-- begin NAME -->`.
bool has_marker(const std::string& page, const std::string& name);

/// Returns the targets of the page's pictures, `![...](TARGET)`, without duplicates, in order.
std::vector<std::string> pictures_of(const std::string& page);

}  // namespace vat::bench

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/support/result.h"

namespace CLI {
class App;
}

namespace vat::bench {

/// Adds `vat bench document`. It runs during the parse and sets `exit_code`.
void add_document_command(CLI::App& app, int& exit_code);

/// Returns the names of the markers that can be filled.
std::vector<std::string> document_markers();

/// Fills the page's markers from the results in `results`/validate, /accuracy and /stability, and
/// copies the pictures of the page from there. After an error the page is unchanged.
Status write_document(const std::filesystem::path& results, const std::filesystem::path& page);

}  // namespace vat::bench

#pragma once

#include <filesystem>

#include "core/support/result.h"

namespace CLI {
class App;
}

namespace vat::bench {

/// Adds `vat bench document`; it runs during the parse and leaves its result in `exit_code`.
void add_document_command(CLI::App& app, int& exit_code);

/// Fills the page's markers from the results in `results`/validate, /accuracy and /stability, and
/// copies each picture that the page names from there. An error changes nothing in the page.
Status write_document(const std::filesystem::path& results, const std::filesystem::path& page);

}  // namespace vat::bench

#pragma once

namespace CLI {
class App;
}

namespace vat::bench {

/// Adds `vat bench compare`. It runs during the parse and sets `exit_code`.
void add_compare_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench

#pragma once

namespace CLI {
class App;
}

namespace vat::bench {

/// Adds `vat bench rounding`. It runs during the parse and sets `exit_code`.
void add_rounding_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench

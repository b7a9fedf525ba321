#pragma once

namespace CLI {
class App;
}

namespace vat {

/// Adds `vat simulate`; it runs during the parse and leaves its result in `exit_code`.
void add_simulate_command(CLI::App& app, int& exit_code);

}  // namespace vat

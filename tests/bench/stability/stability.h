#pragma once

namespace CLI {
class App;
}

namespace vat::bench {

/// Adds `vat bench stability`; it runs during the parse and leaves its result in `exit_code`.
void add_stability_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench

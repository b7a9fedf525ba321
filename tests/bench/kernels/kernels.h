#pragma once

namespace CLI {
class App;
}

namespace vat::bench {

/// Adds `vat bench kernels`. It runs during the parse and sets `exit_code`.
void add_kernels_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench

#pragma once

namespace CLI {
class App;
}

namespace vat::bench {

/// Adds `vat bench accuracy`. It runs during the parse and sets `exit_code`.
void add_accuracy_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench

#pragma once

namespace CLI {
class App;
}

namespace vat::bench {

/// Adds `vat bench speed`; it runs during the parse and leaves its result in `exit_code`.
void add_speed_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench

#pragma once

namespace CLI {
class App;
}

namespace vat {

/// Adds `vat serve`; it runs during the parse until SIGINT or SIGTERM, and leaves its result in
/// `exit_code`.
void add_serve_command(CLI::App& app, int& exit_code);

}  // namespace vat

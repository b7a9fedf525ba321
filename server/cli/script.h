#pragma once

namespace CLI {
class App;
}

namespace vat {

/// Adds `vat script`: plays scripts of the protocol against a server.
void add_script_command(CLI::App& app, int& exit_code);

}  // namespace vat

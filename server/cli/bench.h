#pragma once

namespace CLI {
class App;
}

namespace vat {

/// Adds `vat bench`; it runs during the parse and leaves its result in `exit_code`.
void add_bench_command(CLI::App& app, int& exit_code);

}  // namespace vat

#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// `vat bench codec`: size and time of frames, on recorded runs.
void add_codec_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench

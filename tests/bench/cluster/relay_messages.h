#pragma once

#include <CLI/CLI.hpp>

namespace vat::bench {

/// Adds the command `relay-messages`: messages of clients at two relays to one owner.
void add_relay_messages_command(CLI::App& app, int& exit_code);

}  // namespace vat::bench

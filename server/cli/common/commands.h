#pragma once

namespace CLI {
class App;
}

namespace vat {

/// Adds `vat serve`, which runs until SIGINT or SIGTERM. Each command runs during the parsing of
/// the arguments and writes its exit code to `exit_code`.
void add_serve_command(CLI::App& app, int& exit_code);
/// Adds `vat simulate`.
void add_simulate_command(CLI::App& app, int& exit_code);
/// Adds `vat tune`, which measures the numerics of a scene.
void add_tune_command(CLI::App& app, int& exit_code);
/// Adds `vat validate`.
void add_validate_command(CLI::App& app, int& exit_code);
/// Adds `vat convert`, which reads scenes of SPlisHSPlasH.
void add_convert_command(CLI::App& app, int& exit_code);
/// Adds `vat devices`.
void add_devices_command(CLI::App& app, int& exit_code);
/// Adds `vat script`, which plays protocol scripts against a server.
void add_script_command(CLI::App& app, int& exit_code);
/// Adds `vat replay`.
void add_replay_command(CLI::App& app, int& exit_code);
/// Adds `vat record`, which computes a scene and writes the frames of a viewer.
void add_record_command(CLI::App& app, int& exit_code);
/// Adds `vat export`, which writes a recording as a page.
void add_export_command(CLI::App& app, int& exit_code);
/// Adds `vat backup` and `vat restore`.
void add_backup_commands(CLI::App& app, int& exit_code);
/// Adds `vat complete`, which the completion of shells runs. The help does not list it.
void add_complete_command(CLI::App& app, int& exit_code);

}  // namespace vat

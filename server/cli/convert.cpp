#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>

#include "protocol/convert/splishsplash.h"
#include "protocol/files/output_file.h"
#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"

namespace vat {
namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  std::string source;
  std::string output;  ///< empty: standard output
};

std::string check_scene_name(const std::string& name) {
  const bool good = fs::path(name).extension() == ".json";
  return good ? std::string() : "'" + name + "' must end in .json";
}

Result<ConvertedScene> convert_file(const fs::path& file) {
  const fs::path folder = file.parent_path();
  const MeshSource files = meshes_relative_to(folder.empty() ? "." : folder.string());
  const Result<std::string> text = files(file.filename().string());
  if (!text) return text.errors();
  const Result<Json> document = parse_json(text.value(), kSplishsplashLimits);
  if (!document) return document.errors();
  return convert_splishsplash(document.value(), files);
}

int convert(const ConvertOptions& options) {
  const Result<ConvertedScene> converted = convert_file(options.source);
  if (!converted) return fail(options.source, converted.errors());
  const std::string text = scene_text(converted.value().document);
  if (options.output.empty()) {
    std::cout << text;
  } else if (const Status written = write_output_file(options.output, text); !written) {
    return fail(options.output, written.errors());
  }
  for (const Omission& omission : converted.value().omissions) {
    std::cerr << "omitted: " << omission.path << ": " << omission.reason << '\n';
  }
  return kExitOk;
}

void check_files(const ConvertOptions& options) {
  std::error_code failed;
  if (!options.output.empty() && fs::equivalent(options.source, options.output, failed)) {
    throw CLI::ValidationError("output", "must not be the converted file");
  }
}

}  // namespace

void add_convert_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("convert", "Convert a SPlisHSPlasH scene to a scene file");
  const auto options = std::make_shared<ConvertOptions>();
  command->add_option("source", options->source, "Scene file of SPlisHSPlasH")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("output", options->output, "Scene file to write; default: standard output")
      ->check(CLI::Validator(check_scene_name, "FILE"));
  command->footer(
      "Prints each member of the converted file that the scene does not contain, with the reason. "
      "The y axis becomes the z axis. Exit codes: 0 converted, 1 invalid file, 2 wrong usage.");
  command->callback([options, &exit_code] {
    check_files(*options);
    exit_code = convert(*options);
  });
}

}  // namespace vat

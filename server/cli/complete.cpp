#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"
#include "server/cli/common/data_folders.h"
#include "server/cli/common/scene_argument.h"

namespace vat {
namespace {

using Words = std::vector<std::string>;

bool is_option(const std::string& word) {
  return word.starts_with("-");
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() > 0;
}

Words long_options(const CLI::App& app) {
  Words names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

Words command_names(const CLI::App& app) {
  Words names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (!command->get_group().empty()) names.push_back(command->get_name());
  }
  return names;
}

const CLI::App* find_command(const CLI::App& app, const std::string& name) {
  const auto commands = app.get_subcommands({});
  const auto found = std::ranges::find(commands, name, &CLI::App::get_name);
  return found == commands.end() ? nullptr : *found;
}

/// Returns the values of an option whose type is a set, such as "TEXT:{coarse, normal}". Other
/// options have none.
Words listed_values(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos || end < begin) return {};
  Words values = CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
  for (std::string& value : values) CLI::detail::trim(value);
  return values;
}

/// Returns the scenes of the catalogue that the words name with --scenes, or of the program's.
Words scenes(const Words& words) {
  const auto option = std::ranges::find(words, "--scenes");
  const bool is_given = option != words.end() && option + 1 != words.end();
  const Result<Words> names = catalogue_names(is_given ? *(option + 1) : installed_scenes_folder());
  return names ? names.value() : Words();
}

Words values_of(const CLI::Option& option, const Words& words) {
  return option.get_name() == "--scene" ? scenes(words) : listed_values(option);
}

/// Returns the option before the last word, if it needs a value.
const CLI::Option* open_option(const CLI::App& command, const Words& words) {
  if (words.size() < 3 || !is_option(words[words.size() - 2])) return nullptr;
  const CLI::Option* option = command.get_option_no_throw(words[words.size() - 2]);
  return option != nullptr && takes_value(*option) ? option : nullptr;
}

/// Returns all words that can be in the place of the last word.
Words possible_words(const CLI::App& app, const Words& words) {
  if (words.size() < 2) {
    return words.empty() || !is_option(words.back()) ? command_names(app) : long_options(app);
  }
  const CLI::App* command = find_command(app, words.front());
  if (command == nullptr) return {};
  if (const CLI::Option* option = open_option(*command, words)) return values_of(*option, words);
  if (is_option(words.back())) return long_options(*command);
  const CLI::Option* scene = command->get_option_no_throw("scene");
  return scene != nullptr && scene->get_positional() ? scenes(words) : Words();
}

void print_completions(const CLI::App& app, const Words& words) {
  const std::string begin = words.empty() ? "" : words.back();
  for (const std::string& word : possible_words(app, words)) {
    if (word.starts_with(begin)) std::cout << word << '\n';
  }
}

}  // namespace

void add_complete_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("complete", "Print completions for a shell");
  command->group("");  // not in the help
  const auto words = std::make_shared<Words>();
  command->add_option("words", *words,
                      "Words after the program's name; the last one is incomplete");
  command->callback([&app, words, &exit_code] {
    print_completions(app, *words);
    exit_code = kExitOk;
  });
}

}  // namespace vat

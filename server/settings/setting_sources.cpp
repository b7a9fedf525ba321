#include "server/settings/setting_sources.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/support/nearest_name.h"
#include "protocol/json/printable.h"

namespace vat {
namespace {

constexpr std::string_view kPrefix = "VAT_";

NearestName nearest_setting(std::span<const Setting> settings, std::string_view name) {
  return NearestName(name).consider_all(settings, &Setting::name);
}

const Setting* find(std::span<const Setting> settings, std::string_view name) {
  const auto found = std::ranges::find(settings, name, &Setting::name);
  return found == settings.end() ? nullptr : &*found;
}

std::string names_of(std::span<const Setting> settings) {
  std::string names;
  for (const Setting& setting : settings) names += (names.empty() ? "" : ", ") + setting.name;
  return names;
}

/// Sets all settings, or none if there are errors.
Status apply(const std::vector<std::pair<const Setting*, Json>>& values, Errors errors,
             const std::string& source, SettingSources& sources) {
  if (!errors.empty()) return errors;
  for (const auto& [setting, value] : values) {
    setting->assign(value);
    sources[setting->name] = source;
  }
  return {};
}

Result<Json> read_object(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (stream) text << stream.rdbuf();
  if (!stream || !text) return Error{"unreadable", "", "cannot be read"};
  Result<Json> json = parse_json(text.str());
  if (!json) return json.errors();
  if (!json.value().is_object()) return Error{"wrong_type", "", "must be an object"};
  return json;
}

/// Name and value of "NAME=VALUE".
std::pair<std::string_view, std::string_view> split(std::string_view entry) {
  const std::size_t end = std::min(entry.find('='), entry.size());
  return {entry.substr(0, end), entry.substr(std::min(end + 1, entry.size()))};
}

const Setting* find_by_variable(std::span<const Setting> settings, std::string_view variable) {
  const auto found = std::ranges::find(settings, variable, variable_of);
  return found == settings.end() ? nullptr : &*found;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

}  // namespace

Status apply_file(std::span<const Setting> settings, const std::string& file,
                  SettingSources& sources) {
  const Result<Json> object = read_object(file);
  if (!object) return object.errors();
  Errors errors;
  std::vector<std::pair<const Setting*, Json>> values;
  for (const auto& [name, value] : object.value().items()) {
    const std::string path = pointer_to("", printable(name));
    const Setting* setting = find(settings, name);
    if (setting == nullptr) {
      add_error(errors, with_suggestion({"unknown_member", path,
                                         "is not a setting; there are " + names_of(settings)},
                                        nearest_setting(settings, name).suggestion()));
    } else if (std::string fault = setting->find_fault(value); !fault.empty()) {
      add_error(errors, "bad_value", path, std::move(fault));
    } else {
      values.emplace_back(setting, value);
    }
  }
  return apply(values, std::move(errors), "file " + file, sources);
}

Status apply_environment(std::span<const Setting> settings,
                         const std::vector<std::string>& environment, SettingSources& sources) {
  Errors errors;
  std::vector<std::pair<const Setting*, Json>> values;
  for (const std::string& entry : environment) {
    const auto [variable, text] = split(entry);
    const Setting* setting = find_by_variable(settings, variable);
    if (setting == nullptr) continue;
    Json value = to_json(*setting, std::string(text));
    if (std::string fault = setting->find_fault(value); !fault.empty()) {
      add_error(errors, "bad_value", std::string(variable), std::move(fault));
    } else {
      values.emplace_back(setting, std::move(value));
    }
  }
  return apply(values, std::move(errors), "environment", sources);
}

std::vector<std::string> unknown_variables(std::span<const Setting> settings,
                                           const std::vector<std::string>& environment) {
  std::vector<std::string> unknown;
  for (const std::string& entry : environment) {
    const std::string_view variable = split(entry).first;
    if (!variable.starts_with(kPrefix) || find_by_variable(settings, variable) != nullptr) continue;
    const std::string nearest =
        nearest_setting(settings, lower(variable.substr(kPrefix.size()))).nearest();
    unknown.push_back(printable(variable) + ", not " + variable_of(*find(settings, nearest)) + "?");
  }
  return unknown;
}

void apply_options(std::span<const Setting> settings, const SettingTexts& texts,
                   SettingSources& sources) {
  for (const Setting& setting : settings) {
    const auto text = texts.find(setting.name);
    if (text == texts.end()) continue;
    setting.assign(to_json(setting, text->second));
    sources[setting.name] = "option";
  }
}

Json describe(std::span<const Setting> settings, const SettingSources& sources) {
  Json values = Json::object();
  Json origins = Json::object();
  for (const Setting& setting : settings) {
    const auto source = sources.find(setting.name);
    values[setting.name] = setting.value();
    origins[setting.name] = source == sources.end() ? "default" : source->second;
  }
  return {{"settings", std::move(values)}, {"sources", std::move(origins)}};
}

std::string settings_table(std::span<const Setting> settings) {
  std::string table = "| setting | range | default | description |\n|---|---|---|---|\n";
  std::string group;
  for (const Setting& setting : settings) {
    if (setting.group != group) {
      group = setting.group;
      table += "| **" + group + "** | | | |\n";
    }
    const std::string value = setting.shown_default.empty() ? '`' + to_text(setting.value()) + '`'
                                                            : setting.shown_default;
    table += "| `" + setting.name + "` | " + setting.range + " | " +
             (value == "``" ? "none" : value) + " | " + setting.help + " |\n";
  }
  return table;
}

std::string environment_file(std::span<const Setting> settings) {
  std::string file;
  std::string group;
  for (const Setting& setting : settings) {
    if (setting.group != group) {
      group = setting.group;
      file += "\n## " + group + "\n";
    }
    const std::string value = setting.shown_default.empty() ? to_text(setting.value()) : "";
    file += "\n# " + setting.help + " (" + setting.range + ").\n#" + variable_of(setting) + '=' +
            value + '\n';
  }
  return file;
}

}  // namespace vat

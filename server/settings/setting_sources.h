#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "server/settings/setting.h"

/// Settings from a configuration file, the environment and options. Later sources replace earlier
/// ones.
namespace vat {

/// Source of each setting by its name: "default", "file FILE", "environment", "option".
using SettingSources = std::map<std::string, std::string>;

/// Texts by name of setting.
using SettingTexts = std::map<std::string, std::string>;

/// Applies a configuration file: one JSON object. Errors have JSON pointers as paths. The error of
/// an unknown name suggests the nearest one and lists all.
Status apply_file(std::span<const Setting> settings, const std::string& file,
                  SettingSources& sources);

/// Applies the variables VAT_*, given as "NAME=VALUE". The path of an error is the variable.
Status apply_environment(std::span<const Setting> settings,
                         const std::vector<std::string>& environment, SettingSources& sources);
/// Returns the variables VAT_* that do not name a setting, each with the most similar setting:
/// "VAT_PROT, not VAT_PORT?". They are not errors, because other programs may use such names.
std::vector<std::string> unknown_variables(std::span<const Setting> settings,
                                           const std::vector<std::string>& environment);

/// Applies options, which must be valid.
void apply_options(std::span<const Setting> settings, const SettingTexts& texts,
                   SettingSources& sources);

/// Returns the current settings as a configuration file, with their sources.
Json describe(std::span<const Setting> settings, const SettingSources& sources);

/// Returns a Markdown table of the settings.
std::string settings_table(std::span<const Setting> settings);

}  // namespace vat

#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "server/settings/setting.h"

/// Settings from a configuration file, the environment and options. A later source overrides an
/// earlier source.
namespace vat {

/// Source of each setting: "default", "file FILE", "environment" or "option". The key is the name
/// of the setting.
using SettingSources = std::map<std::string, std::string>;

/// Texts of settings. The key is the name of the setting.
using SettingTexts = std::map<std::string, std::string>;

/// Applies a configuration file (one JSON object). The paths of errors are JSON pointers. The error
/// for an unknown name contains the most similar name and a list of all names.
Status apply_file(std::span<const Setting> settings, const std::string& file,
                  SettingSources& sources);

/// Applies the environment variables VAT_*, given as "NAME=VALUE". The path of an error is the
/// variable name.
Status apply_environment(std::span<const Setting> settings,
                         const std::vector<std::string>& environment, SettingSources& sources);
/// Returns the variables VAT_* that do not name a setting, each with the most similar setting:
/// "VAT_PROT, not VAT_PORT?". Unknown variables are not errors, because other programs may use such
/// names.
std::vector<std::string> unknown_variables(std::span<const Setting> settings,
                                           const std::vector<std::string>& environment);

/// Applies options. The texts must be valid.
void apply_options(std::span<const Setting> settings, const SettingTexts& texts,
                   SettingSources& sources);

/// Returns the current settings in the form of a configuration file, with their sources.
Json describe(std::span<const Setting> settings, const SettingSources& sources);

/// Returns a Markdown table of the settings.
std::string settings_table(std::span<const Setting> settings);

/// Returns the current settings as environment variables, one per line. Each is commented out and
/// follows its description and range.
std::string environment_file(std::span<const Setting> settings);

}  // namespace vat

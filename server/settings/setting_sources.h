#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "server/settings/setting.h"

/// Settings come from a configuration file, from the environment, and from options; a later one of
/// these counts more.
namespace vat {

/// Where each setting's value came from, by its name: "default", "file FILE", "environment",
/// "option".
using SettingSources = std::map<std::string, std::string>;

/// Texts by the names of settings.
using SettingTexts = std::map<std::string, std::string>;

/// The settings of a configuration file: one JSON object. Errors have JSON pointers as paths; an
/// unknown name is told together with the nearest one, and all there are.
Status apply_file(std::span<const Setting> settings, const std::string& file,
                  SettingSources& sources);

/// Those of the variables VAT_*, given as "NAME=VALUE". The path of an error is the variable.
Status apply_environment(std::span<const Setting> settings,
                         const std::vector<std::string>& environment, SettingSources& sources);
/// Variables VAT_* that are no setting, each with the nearest one: "VAT_PROT, not VAT_PORT?". They
/// are not refused, since others give variables such names.
std::vector<std::string> unknown_variables(std::span<const Setting> settings,
                                           const std::vector<std::string>& environment);

/// Those of options, found to be good before.
void apply_options(std::span<const Setting> settings, const SettingTexts& texts,
                   SettingSources& sources);

/// The settings in force, as a configuration file, and where each came from.
Json describe(std::span<const Setting> settings, const SettingSources& sources);

/// A table for people, in Markdown.
std::string settings_table(std::span<const Setting> settings);

}  // namespace vat

#pragma once

#include <string>

/// Folders of the program's data: share/vat next to the folder of the program. An installation and
/// a build have the same layout, so that both can be moved.
namespace vat {

/// Returns the folder of the scene catalogue.
std::string installed_scenes_folder();

/// Returns the folder of the built viewer.
std::string installed_web_folder();

}  // namespace vat

#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/result.h"
#include "tests/bench/speed/measure.h"

namespace vat::bench {

/// A scene to be timed, and the duration.
struct SpeedCase {
  std::string name;
  std::function<Result<Scene>()> make;
  SpeedSettings settings;
  bool is_long = false;  ///< quick runs include it only by name
};

/// Returns all cases. Catalogue scenes are read from `scenes_folder`.
std::vector<SpeedCase> all_speed_cases(const std::string& scenes_folder);

/// Returns the case of a scene given by a user; see load_scene().
SpeedCase case_of_scene(const std::string& argument, const std::string& scenes_folder);

}  // namespace vat::bench

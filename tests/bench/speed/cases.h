#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/result.h"
#include "tests/bench/speed/measure.h"

namespace vat::bench {

/// One scene to be timed, and for how long.
struct SpeedCase {
  std::string name;
  std::function<Result<Scene>()> make;
  SpeedSettings settings;
  bool is_long = false;  ///< left out of quick runs, unless it is named
};

/// All of them. Scenes of the catalogue are read from `scenes_folder`.
std::vector<SpeedCase> all_speed_cases(const std::string& scenes_folder);

/// A scene that a user names; see load_scene().
SpeedCase case_of_scene(const std::string& argument, const std::string& scenes_folder);

}  // namespace vat::bench

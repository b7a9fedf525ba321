#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/support/result.h"

namespace vat::bench {

/// Returns the instructions of a scene's counted steps, measured by callgrind. Writes its complete
/// output to FOLDER/SCENE.callgrind, for callgrind_annotate. Fails if valgrind is missing or fails.
Result<std::uint64_t> count_instructions(const std::string& scene,
                                         const std::filesystem::path& folder);

/// The sub-command of this program that runs under callgrind.
inline constexpr const char* kCountedCommand = "run-counted-scene";

/// Returns the count in callgrind's output.
Result<std::uint64_t> parse_callgrind_total(const std::filesystem::path& file);

}  // namespace vat::bench

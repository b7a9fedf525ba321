#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/support/result.h"

namespace vat::bench {

/// Instructions that the counted steps of a scene take, by callgrind; its whole output, for
/// callgrind_annotate, is then FOLDER/SCENE.callgrind. Fails where valgrind does, or is not there.
Result<std::uint64_t> count_instructions(const std::string& scene,
                                         const std::filesystem::path& folder);

/// The sub-command of this program that callgrind watches.
inline constexpr const char* kCountedCommand = "run-counted-scene";

/// The count in callgrind's output.
Result<std::uint64_t> parse_callgrind_total(const std::filesystem::path& file);

}  // namespace vat::bench

#pragma once

#include <string>

namespace vat {

/// Returns version, commit and instruction sets of the program, such as "vat 0.1.0 (commit
/// 0123456789ab; instruction sets baseline, avx2)". The commit is absent if the sources were not in
/// a Git repository. The instruction sets are those of this machine.
std::string version_text();

}  // namespace vat

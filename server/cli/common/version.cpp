#include "server/cli/common/version.h"

#include "core/support/instruction_set.h"

namespace vat {

/// In a file that the build writes.
extern const char* const kCommit;

std::string version_text() {
  std::string sets;
  for (const InstructionSet set : available_instruction_sets()) {
    sets += (sets.empty() ? "" : ", ") + std::string(to_string(set));
  }
  const std::string commit = kCommit;
  return "vat " VAT_VERSION " (" + (commit.empty() ? "" : "commit " + commit + "; ") +
         "instruction sets " + sets + ")";
}

}  // namespace vat

#include "server/cli/common/command.h"

#include <iostream>

#include "core/validation/validate.h"

namespace vat {

void print_errors(std::ostream& out, const std::string& input, const Errors& errors) {
  for (const Error& error : errors) {
    out << (error.path.empty() ? input : error.path) << ": " << error.message << '\n';
  }
}

void print_warnings(const std::string& input, const Scene& scene) {
  for (const Warning& warning : find_warnings(scene)) {
    std::cerr << "warning: " << (warning.path.empty() ? input : warning.path) << ": "
              << warning.message << '\n';
  }
}

int fail(const std::string& input, const Errors& errors) {
  print_errors(std::cerr, input, errors);
  return kExitFailed;
}

}  // namespace vat

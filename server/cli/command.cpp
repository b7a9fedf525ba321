#include "server/cli/command.h"

#include <iostream>

namespace vat {

void print_errors(std::ostream& out, const std::string& input, const Errors& errors) {
  for (const Error& error : errors) {
    out << (error.path.empty() ? input : error.path) << ": " << error.message << '\n';
  }
}

int fail(const std::string& input, const Errors& errors) {
  print_errors(std::cerr, input, errors);
  return kExitFailed;
}

}  // namespace vat

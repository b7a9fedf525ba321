#include <exception>
#include <iostream>

#include "server/cli/common/command.h"
#include "server/cli/program.h"

int main(int argc, char** argv) {
  try {
    const int exit_code = vat::run_command(argc, argv);
    if (std::cout.flush()) return exit_code;
    std::cerr << "vat: standard output cannot be written\n";  // a full disk, say
    return vat::kExitFailed;
  } catch (const std::exception& error) {
    std::cerr << "vat: " << error.what() << '\n';
    return vat::kExitFailed;
  }
}

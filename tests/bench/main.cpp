#include <exception>
#include <iostream>

#include "server/cli/common/command.h"
#include "tests/bench/program.h"

int main(int argc, char** argv) {
  try {
    const int exit_code = vat::bench::run_command(argc, argv);
    if (std::cout.flush()) return exit_code;
    std::cerr << "vat bench: standard output cannot be written\n";  // for example, the disk is full
  } catch (const std::exception& error) {
    std::cerr << "vat bench: " << error.what() << '\n';
  }
  return vat::kExitFailed;
}

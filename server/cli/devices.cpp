#include <CLI/CLI.hpp>
#include <iomanip>
#include <iostream>

#include "core/device/opencl/devices.h"
#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"

namespace vat {

namespace {

int print_devices() {
  const Result<std::vector<opencl::Device>> devices = opencl::list_devices();
  if (!devices) return fail("devices", devices.errors());
  for (std::size_t d = 0; d < devices.value().size(); ++d) {
    const opencl::Device& device = devices.value()[d];
    std::cout << "opencl:" << d << "  " << device.name << ", " << device.driver << ", "
              << std::setprecision(3) << static_cast<double>(device.memory) / 1e9 << " GB, "
              << device.compute_units << " compute units, "
              << (device.is_exact ? "exact arithmetic" : "no exact arithmetic")
              << (device.has_doubles ? "" : ", not usable: no double precision") << '\n';
  }
  if (devices.value().empty()) std::cout << "no OpenCL devices\n";
  return kExitOk;
}

}  // namespace

void add_devices_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("devices", "List the OpenCL devices of this machine for --device");
  command->footer("Exit codes: 0 success, 1 the machine has no OpenCL library, 2 wrong usage.");
  command->callback([&exit_code] { exit_code = print_devices(); });
}

}  // namespace vat

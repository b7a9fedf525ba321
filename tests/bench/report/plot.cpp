#include "tests/bench/report/plot.h"

#include <string>
#include <system_error>

#include "tests/bench/report/run_program.h"
#include "tests/bench/report/table.h"

namespace vat::bench {

namespace {

/// Runs `gnuplot ARGUMENT` in a folder, with its messages in `log`.
Status run_gnuplot(const std::string& argument, const std::filesystem::path& folder,
                   const std::string& log) {
  return run_program({"gnuplot", argument}, folder, log, "./vat packages bench installs it");
}

Status draw(const std::string& data, const std::string& script, const std::filesystem::path& folder,
            const std::string& name) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{"system", folder.string(), error.message()};
  if (Status done = write_text(folder / (name + ".dat"), data); !done) return done;
  if (Status done = write_text(folder / (name + ".gnuplot"), script); !done) return done;
  const std::string log = name + ".log";
  if (Status done = run_gnuplot(name + ".gnuplot", folder, log); !done) return done;
  std::filesystem::remove(folder / log, error);
  return error ? Status(Error{"system", (folder / log).string(), error.message()}) : Status();
}

}  // namespace

Status find_gnuplot() {
  return run_gnuplot("--version", ".", "/dev/null");
}

Status write_plot(const LogPlot& plot, const std::filesystem::path& folder,
                  const std::string& name) {
  if (!can_be_drawn(plot)) return Error{"no_points", name, "there are no points to draw"};
  return draw(plot_data(plot), plot_script(plot, name), folder, name);
}

Status write_plot(const GridPlot& plot, const std::filesystem::path& folder,
                  const std::string& name) {
  return draw(plot_data(plot), plot_script(plot, name), folder, name);
}

}  // namespace vat::bench

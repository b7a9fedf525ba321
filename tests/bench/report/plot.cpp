#include "tests/bench/report/plot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "tests/bench/report/table.h"

namespace vat::bench {

namespace {

/// Runs `gnuplot ARGUMENT` in a folder, with its messages in `log`.
Status run_gnuplot(std::string argument, const std::filesystem::path& folder,
                   const std::string& log) {
  std::string program = "gnuplot";
  char* argv[] = {program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0666);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t pid = -1;
  const int failed = posix_spawnp(&pid, argv[0], &actions, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    return Error{"gnuplot", "gnuplot",
                 std::string("cannot be started (") + std::strerror(failed) +
                     "); ./vat packages bench installs it"};
  }
  int status = 0;
  while (waitpid(pid, &status, 0) < 0) {
    if (errno != EINTR) return Error{"gnuplot", "gnuplot", std::strerror(errno)};
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  std::ostringstream message;
  message << std::ifstream(folder / log).rdbuf();
  return Error{"gnuplot", argument, "gnuplot failed: " + message.str()};
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

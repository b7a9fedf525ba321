#include "server/cli/serve/certificate_watch.h"

#include <sys/stat.h>

#include <csignal>
#include <exception>
#include <utility>

#include "server/support/log.h"

namespace vat {
namespace {

std::string state_of(const std::vector<std::string>& files) {
  std::string state;
  for (const std::string& file : files) {
    struct stat status = {};
    if (stat(file.c_str(), &status) != 0) status = {};
    state += fmt::format("{} {} {} {}.{}\n", status.st_dev, status.st_ino, status.st_size,
                         status.st_mtim.tv_sec, status.st_mtim.tv_nsec);
  }
  return state;
}

}  // namespace

CertificateWatch::CertificateWatch(boost::asio::io_context& io, std::vector<std::string> files,
                                   std::function<void()> read, std::chrono::milliseconds interval)
    : files_(std::move(files)),
      read_(std::move(read)),
      interval_(interval),
      state_(state_of(files_)),
      signals_(io, SIGHUP),
      timer_(io) {
  wait_for_signal();
  wait_for_change();
}

void CertificateWatch::wait_for_signal() {
  signals_.async_wait([this](boost::system::error_code cancelled, int) {
    if (cancelled) return;
    read_again();
    wait_for_signal();
  });
}

void CertificateWatch::wait_for_change() {
  timer_.expires_after(interval_);
  timer_.async_wait([this](boost::system::error_code cancelled) {
    if (cancelled) return;
    if (state_of(files_) != state_) read_again();
    wait_for_change();
  });
}

void CertificateWatch::read_again() {
  state_ = state_of(files_);  // before the read, so that a change during the read is seen later
  try {
    read_();
    log_info("new connections use the certificate that was read from {}", files_.front());
  } catch (const std::exception& fault) {
    log_error("the previous certificate remains in use: {}", fault.what());
  }
}

}  // namespace vat

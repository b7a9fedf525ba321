#include "server/cli/simulate/simulate_interrupt.h"

#include <csignal>

namespace vat {

namespace {

volatile std::sig_atomic_t noted_signal = 0;  // a handler can reach nothing else

extern "C" void note_signal(int signal) {
  noted_signal = signal;
}

void watch(int signal) {
  struct sigaction before {};
  sigaction(signal, nullptr, &before);
  if (before.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = note_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(signal, &action, nullptr);
}

void unwatch(int signal) {
  struct sigaction now {};
  sigaction(signal, nullptr, &now);
  if (now.sa_handler == note_signal) std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptWatch::InterruptWatch() {
  noted_signal = 0;
  watch(SIGINT);
  watch(SIGTERM);
}

InterruptWatch::~InterruptWatch() {
  unwatch(SIGINT);
  unwatch(SIGTERM);
}

int InterruptWatch::signal() const {
  return noted_signal;
}

}  // namespace vat

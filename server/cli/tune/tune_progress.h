#pragma once

#include <chrono>
#include <string>

#include "protocol/tune/search.h"

namespace vat {

/// Line on stderr with the progress of `vat tune` and an estimate of the remaining time. Visible
/// only if stderr is a terminal, and cleared at the end.
class TuneProgress {
 public:
  TuneProgress();
  ~TuneProgress();
  TuneProgress(const TuneProgress&) = delete;
  TuneProgress& operator=(const TuneProgress&) = delete;

  void show(const std::string& stage, const tune::Progress& progress);

 private:
  bool visible_;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace vat

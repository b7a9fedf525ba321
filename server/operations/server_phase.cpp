#include "server/operations/server_phase.h"

namespace vat {

const char* to_string(ServerPhase phase) {
  switch (phase) {
    case ServerPhase::starting:
      return "starting";
    case ServerPhase::recovering:
      return "recovering";
    case ServerPhase::ready:
      return "ready";
    case ServerPhase::draining:
      return "draining";
  }
  return "";
}

}  // namespace vat

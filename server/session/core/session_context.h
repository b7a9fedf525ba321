#pragma once

#include <string>

#include "server/people/session_settings.h"
#include "server/session/core/session_environment.h"
#include "server/support/thread_owner.h"

namespace vat {

class Playback;

/// State that all parts of one session use.
struct SessionContext {
  std::string id;
  SessionSettings settings;
  const SessionEnvironment* environment = nullptr;
  Playback* playback = nullptr;  ///< null: the session is not a replay
  ThreadOwner owner;             ///< held by the session's strand during a turn
};

}  // namespace vat

#pragma once

#include <string>

#include "server/people/session_settings.h"
#include "server/session/core/session_environment.h"
#include "server/support/thread_owner.h"

namespace vat {

class Playback;

/// State that all parts of a session share.
struct SessionContext {
  std::string id;
  SessionSettings settings;
  const SessionEnvironment* environment = nullptr;
  Playback* playback = nullptr;  ///< null: the session is not a replay
  ThreadOwner owner;             ///< held by the strand's thread during a turn, see Session
};

}  // namespace vat

#pragma once

#include <boost/asio/thread_pool.hpp>

#include "core/support/instruction_set.h"
#include "protocol/scene/scene_json.h"
#include "server/access/access.h"
#include "server/admission/resource_budget.h"
#include "server/clock.h"
#include "server/limits.h"
#include "server/server_metrics.h"
#include "server/task_runner.h"

namespace vat {

class Downloads;
class SavedScenes;
class SavedStates;

/// What all sessions share.
struct SessionEnvironment {
  const Catalogue& catalogue;
  const ServerLimits& limits;
  InstructionSet instructions;
  ThreadPoolRunner& runner;  ///< for the blocks of all sessions' steps
  ServerMetrics& metrics;
  ResourceBudget& resources;
  boost::asio::thread_pool& frame_threads;  ///< quantise, encode and send all sessions' frames
  AccessTokens& tokens;
  Clock& clock;
  Downloads* downloads = nullptr;  ///< null: nobody fetches files
  // Null: nothing can be saved.
  SavedStates* states = nullptr;
  SavedScenes* scenes = nullptr;
};

}  // namespace vat

#pragma once

#include <exception>
#include <string_view>

#include "server/clients/pending_reply.h"
#include "server/support/log.h"

namespace vat {

/// Answers a request with the result of `work`. If `work` throws an exception, logs the exception
/// and answers with an error. `what` is the prefix of the log message.
template <class Work>
void answer_with(PendingReply& reply, std::string_view what, Work&& work) {
  try {
    reply.answer(work());
  } catch (const StorageError& error) {
    log_error("{}: {}", what, error.what());
    reply.answer(storage_failed(error.kind()));
  } catch (const std::exception& error) {
    log_error("{}: {}", what, error.what());
    reply.answer(internal_error());
  }
}

}  // namespace vat

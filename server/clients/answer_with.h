#pragma once

#include <exception>
#include <string_view>
#include <utility>

#include "server/clients/pending_reply.h"
#include "server/support/log.h"

namespace vat {

/// Calls `answer` with the result of `work`. If one of them throws an exception, logs the exception
/// and answers the request with an error. `what` is the prefix of the log message.
template <class Work, class Answer>
void answer_with(PendingReply& reply, std::string_view what, Work&& work, Answer&& answer) {
  try {
    answer(work());
  } catch (const StorageError& error) {
    log_error("{}: {}", what, error.what());
    reply.answer(storage_failed(error.kind()));
  } catch (const std::exception& error) {
    log_error("{}: {}", what, error.what());
    reply.answer(internal_error());
  }
}

/// Answers a request with the result of `work`, as above.
template <class Work>
void answer_with(PendingReply& reply, std::string_view what, Work&& work) {
  answer_with(reply, what, std::forward<Work>(work),
              [&reply](const RpcResult& result) { reply.answer(result); });
}

}  // namespace vat

#include "server/messages/error_table.h"

#include <cstddef>
#include <iterator>

namespace vat {
namespace {

constexpr ErrorRow kRows[] = {
    {ErrorKind::parse_error, -32700, "parse_error",
     "Send one JSON object in UTF-8; data.reason and the message name the problem."},
    {ErrorKind::invalid_request, -32600, "invalid_request",
     "Send a JSON-RPC 2.0 request with jsonrpc, id, method and params, as a text message."},
    {ErrorKind::method_not_found, -32601, "method_not_found", "See the methods of server.info."},
    {ErrorKind::invalid_params, -32602, "invalid_params",
     "Correct the parameters in data.errors; each message names the allowed range."},
    {ErrorKind::internal_error, -32603, "internal_error",
     "The server's log contains the cause; nothing was changed."},
    {ErrorKind::not_joined, 1001, "not_joined", "Call session.join first."},
    {ErrorKind::no_such_session, 1002, "no_such_session",
     "See session.list; the session may have ended."},
    {ErrorKind::no_such_body, 1003, "no_such_body",
     "See the latest description; the body may have been removed."},
    {ErrorKind::no_such_scene, 1004, "no_such_scene", "See the names in scene.list."},
    {ErrorKind::limit_reached, 1005, "limit_reached",
     "Request less, or release resources that count towards data.limit, and try again."},
    {ErrorKind::not_allowed, 1006, "not_allowed",
     "The message names the reason: ask an owner for a role or a controller for control, use a "
     "grab "
     "of your own, or try again later."},
    {ErrorKind::not_authenticated, 1007, "not_authenticated",
     "Send a valid token with access.enter, or ask for a new one."},
    {ErrorKind::busy, 1008, "busy",
     "Wait until data.holder releases the body, or use another body."},
    {ErrorKind::rate_limited, 1009, "rate_limited",
     "Send less often; try again after data.retry_after seconds."},
    {ErrorKind::storage_failed, 1010, "storage_failed",
     "Nothing was changed; delete files on the server's disk, or ask the operator, and try again."},
    {ErrorKind::not_recovered, 1011, "not_recovered",
     "Wait while the session is recovering; for a lost session, the server's log contains the "
     "cause."},
    {ErrorKind::moved, 1012, "moved",
     "Connect to data.url and send the request there; session.join accepts the same token."},
};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < std::size(kRows); ++i) {
    if (static_cast<std::size_t>(kRows[i].kind) != i) return false;
  }
  return true;
}
static_assert(is_in_order(), "a kind without a row, or a row out of order");

}  // namespace

std::span<const ErrorRow> error_rows() {
  return kRows;
}

const ErrorRow& error_row(ErrorKind kind) {
  return kRows[static_cast<std::size_t>(kind)];
}

}  // namespace vat

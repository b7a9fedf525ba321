#include "server/session/error_table.h"

#include <cstddef>
#include <iterator>

namespace vat {
namespace {

constexpr ErrorRow kRows[] = {
    {ErrorKind::parse_error, -32700, "parse_error",
     "Send one JSON object in UTF-8; data.reason and the message tell what stands in its way."},
    {ErrorKind::invalid_request, -32600, "invalid_request",
     "Send a JSON-RPC 2.0 request with jsonrpc, id, method and params, as a text message."},
    {ErrorKind::method_not_found, -32601, "method_not_found",
     "Look the name up in the methods of server.info."},
    {ErrorKind::invalid_params, -32602, "invalid_params",
     "Mend what data.errors lists; each message names the allowed range."},
    {ErrorKind::internal_error, -32603, "internal_error",
     "The fault is the server's and stands in its log; nothing was changed."},
    {ErrorKind::not_joined, 1001, "not_joined", "Call session.join first."},
    {ErrorKind::no_such_session, 1002, "no_such_session",
     "Look the session up in session.list; it may have ended."},
    {ErrorKind::no_such_body, 1003, "no_such_body",
     "Look the body up in the newest description; it may have been removed."},
    {ErrorKind::no_such_scene, 1004, "no_such_scene", "Look the name up in scene.list."},
    {ErrorKind::limit_reached, 1005, "limit_reached",
     "Ask for less, or end something that counts towards data.limit, and try again."},
    {ErrorKind::not_allowed, 1006, "not_allowed",
     "Ask whoever may: an owner gives roles, a controller hands over; or wait for what the message "
     "tells."},
    {ErrorKind::not_authenticated, 1007, "not_authenticated",
     "Show a token that is good now by access.enter, or ask for a new one."},
    {ErrorKind::busy, 1008, "busy", "Wait until data.holder lets go, or take another body."},
    {ErrorKind::rate_limited, 1009, "rate_limited",
     "Send less often; try again after data.retry_after seconds."},
    {ErrorKind::storage_failed, 1010, "storage_failed",
     "Nothing was changed; free space on the server's disk, or ask who runs it, and try again."},
    {ErrorKind::not_recovered, 1011, "not_recovered",
     "A session that is recovering comes soon; of one that is lost the server's log tells why."},
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

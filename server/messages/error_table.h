#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace vat {

/// Kinds of errors in replies.
enum class ErrorKind : std::uint8_t {
  parse_error,
  invalid_request,
  method_not_found,
  invalid_params,
  internal_error,
  not_joined,
  no_such_session,
  no_such_body,
  no_such_scene,
  limit_reached,
  not_allowed,
  not_authenticated,
  busy,
  rate_limited,
  storage_failed,
  not_recovered
};

/// Properties of all errors of a kind. Codes and names do not change. A new error gets a new kind.
struct ErrorRow {
  ErrorKind kind;
  int code;               ///< the reply's `code`
  std::string_view name;  ///< its `data.kind`
  std::string_view hint;  ///< its `data.hint`: a sentence that says how to continue
};

/// Returns one row per kind, in their order: the table of errors in PROTOCOL.md.
std::span<const ErrorRow> error_rows();
const ErrorRow& error_row(ErrorKind kind);

}  // namespace vat

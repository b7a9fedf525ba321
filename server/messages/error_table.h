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
  not_recovered,
  moved
};

/// Properties of all errors of a kind. Codes and names do not change. A new type of error gets a
/// new kind.
struct ErrorRow {
  ErrorKind kind;
  int code;               ///< member `code` of the error
  std::string_view name;  ///< member `data.kind` of the error
  std::string_view hint;  ///< member `data.hint`: a sentence that states how to continue
};

/// Returns the table of errors in PROTOCOL.md: one row per kind, in the order of ErrorKind.
std::span<const ErrorRow> error_rows();
const ErrorRow& error_row(ErrorKind kind);

}  // namespace vat

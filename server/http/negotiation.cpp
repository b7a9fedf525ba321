#include "server/http/negotiation.h"

#include <charconv>
#include <optional>
#include <system_error>

#include "server/support/header_text.h"

namespace vat {

namespace {

/// Below every weight that a header can state.
constexpr double kUnnamedIdentity = 1e-4;

/// Returns the weight among the parameters of an element; 1 without a weight, 0 if it is malformed.
double weight_among(std::string_view parameters) {
  const std::string_view parameter = take_part(parameters, ';');
  if (parameter.empty()) return 1;
  double weight = 0;
  if (!equal_ignoring_case(parameter.substr(0, 2), "q=")) return 0;
  const char* const end = parameter.data() + parameter.size();
  const auto [stop, error] = std::from_chars(parameter.data() + 2, end, weight);
  const bool is_weight = error == std::errc() && stop == end && weight >= 0 && weight <= 1;
  return is_weight ? weight : 0;
}

}  // namespace

double weight_of(Encoding encoding, std::string_view accept_encoding) {
  std::optional<double> any;
  while (!accept_encoding.empty()) {
    std::string_view element = take_part(accept_encoding, ',');
    const std::string_view name = take_part(element, ';');
    if (equal_ignoring_case(name, to_string(encoding))) return weight_among(element);
    if (name == "*") any = weight_among(element);
  }
  return any.value_or(encoding == Encoding::identity ? kUnnamedIdentity : 0);
}

bool contains_tag(std::string_view if_none_match, std::string_view tag) {
  while (!if_none_match.empty()) {
    std::string_view element = take_part(if_none_match, ',');
    if (element == "*") return true;
    if (element.starts_with("W/")) element.remove_prefix(2);  // the comparison is weak
    if (element == tag) return true;
  }
  return false;
}

}  // namespace vat

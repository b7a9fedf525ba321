#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

namespace vat {

/// Placeholder that converts to a member of any type.
struct AnyMember {
  std::size_t index;
  template <class T>
  operator T() const;
};

template <class T, std::size_t... indices>
constexpr bool has_members(std::index_sequence<indices...>) {
  return requires {
    T{AnyMember{indices}...};
  };
}

/// Returns the number of members of an aggregate.
template <class T, std::size_t count = 1>
constexpr std::size_t member_count() {
  static_assert(std::is_aggregate_v<T>);
  if constexpr (has_members<T>(std::make_index_sequence<count + 1>())) {
    return member_count<T, count + 1>();
  } else {
    return count;
  }
}

/// Calls `visit` once with all members of an aggregate, in the order of declaration. The function
/// has one branch for each supported number of members.
template <class T, class Visit>
void visit_members(T& value, Visit& visit) {
  constexpr std::size_t count = member_count<std::remove_const_t<T>>();
  if constexpr (count == 2) {
    auto& [a, b] = value;
    visit(a, b);
  } else if constexpr (count == 3) {
    auto& [a, b, c] = value;
    visit(a, b, c);
  } else if constexpr (count == 4) {
    auto& [a, b, c, d] = value;
    visit(a, b, c, d);
  } else if constexpr (count == 5) {
    auto& [a, b, c, d, e] = value;
    visit(a, b, c, d, e);
  } else if constexpr (count == 6) {
    auto& [a, b, c, d, e, f] = value;
    visit(a, b, c, d, e, f);
  } else if constexpr (count == 7) {
    auto& [a, b, c, d, e, f, g] = value;
    visit(a, b, c, d, e, f, g);
  } else if constexpr (count == 10) {
    auto& [a, b, c, d, e, f, g, h, i, j] = value;
    visit(a, b, c, d, e, f, g, h, i, j);
  } else if constexpr (count == 11) {
    auto& [a, b, c, d, e, f, g, h, i, j, k] = value;
    visit(a, b, c, d, e, f, g, h, i, j, k);
  } else {
    static_assert(count == 24);
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x] = value;
    visit(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x);
  }
}

}  // namespace vat

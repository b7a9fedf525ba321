#include "server/session/method_table.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace vat {
namespace {

const MethodRules& rules_of(std::string_view method) {
  const auto found = std::ranges::find(method_rules(), method, &MethodRules::method);
  if (found == method_rules().end()) {
    throw std::logic_error("no rules for the method " + std::string(method));
  }
  return *found;
}

}  // namespace

const std::vector<Method>& all_methods() {
  static const std::vector<Method> kMethods = [] {
    std::vector<Method> all;
    for (const auto group : {server_methods(), session_methods(), control_methods(),
                             world_methods(), grab_methods(), frame_methods(), state_methods()}) {
      all.insert(all.end(), group.begin(), group.end());
    }
    for (Method& method : all) {
      // Throws where a method has no row: at the first message, and so in every test.
      method.rules = rules_of(method.name);
    }
    return all;
  }();
  return kMethods;
}

const Method* find_method(std::string_view name) {
  const auto& methods = all_methods();
  const auto found = std::ranges::find(methods, name, &Method::name);
  return found == methods.end() ? nullptr : &*found;
}

}  // namespace vat

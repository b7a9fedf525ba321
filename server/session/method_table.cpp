#include "server/session/method_table.h"

#include <algorithm>

namespace vat {
const std::vector<Method>& all_methods() {
  static const std::vector<Method> kMethods = [] {
    std::vector<Method> all;
    for (const auto group :
         {server_methods(), scene_methods(), session_methods(), control_methods(), world_methods(),
          edit_methods(), grab_methods(), frame_methods(), state_methods(), people_methods(),
          presence_methods(), access_methods(), replay_methods(), saved_methods(),
          admin_methods()}) {
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

SessionCommand make_command(std::string_view method, Json params) {
  const Method* found = find_method(method);
  VAT_CHECK(found != nullptr);
  Errors errors;
  ObjectReader reader(params, "", errors);
  SessionAction action = std::get<Method::ForSession>(found->read)(reader, errors);
  VAT_CHECK(errors.empty());
  return {&found->rules, std::move(params), std::move(action)};
}

const Method* find_method(std::string_view name) {
  const auto& methods = all_methods();
  const auto found = std::ranges::find(methods, name, &Method::name);
  return found == methods.end() ? nullptr : &*found;
}

}  // namespace vat

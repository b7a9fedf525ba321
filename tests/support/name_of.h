#pragma once

#include <gtest/gtest.h>

#include <cctype>
#include <string>

namespace vat::test {

/// Names the tests of a suite after their parameters, which are texts or enumerators. Replaces
/// hyphens and spaces, which names of tests cannot have.
struct NameOf {
  template <class Parameter>
  std::string operator()(const testing::TestParamInfo<Parameter>& info) const {
    std::string name;
    if constexpr (requires { to_string(info.param); }) {
      name = to_string(info.param);
    } else {
      name = info.param;
    }
    for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return name;
  }
};

}  // namespace vat::test

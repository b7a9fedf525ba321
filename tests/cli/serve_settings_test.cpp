// Server settings of the built program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace vat::test::serve_settings_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// An environment variable that is set during the object's lifetime.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

TEST(ServeSettings, ComeFromFileEnvironmentAndOptions) {
  const TemporaryFolder folder;
  folder.write("vat.json", R"({"port": 1, "endpoints": 2, "max_sessions": 3})");
  const Variable file("VAT_CONFIG", folder.file("vat.json"));
  const Variable endpoints("VAT_ENDPOINTS", "5");
  const ProgramResult result = run_vat({"serve", "--port", "6", "--print-config"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json settings = nlohmann::json::parse(result.out).at("settings");
  EXPECT_EQ(settings.at("port"), 6);
  EXPECT_EQ(settings.at("endpoints"), 5);
  EXPECT_EQ(settings.at("max_sessions"), 3);
}

TEST(ServeSettings, TheOptionOfAListCanBeRepeated) {
  const ProgramResult result = run_vat(
      {"serve", "--public-name", "a.example", "--public-name", "b.example:8443", "--print-config"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json settings = nlohmann::json::parse(result.out).at("settings");
  EXPECT_EQ(settings.at("public_name"), "a.example,b.example:8443");
  EXPECT_THAT(run_vat({"serve", "--public-name", "a.example", "--public-name", "https://b.example",
                       "--print-config"}),
              exits(2, HasSubstr("must be ASCII host names")));
}

TEST(ServeSettings, AFileWithFaultsIsRefused) {
  const TemporaryFolder folder;
  folder.write("vat.json", R"({"prot": 1})");
  const ProgramResult result = run_vat({"serve", "--config", folder.file("vat.json")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, HasSubstr("vat.json: /prot: is not a setting"));
  EXPECT_THAT(result.err, HasSubstr("did you mean \"port\"?"));
  EXPECT_EQ(run_vat({"serve", "--config", folder.file("none.json")}).exit_code, 1);
}

TEST(ServeSettings, AVariableWithABadValueIsRefused) {
  const Variable port("VAT_PORT", "http");
  const ProgramResult result = run_vat({"serve", "--print-config"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("VAT_PORT: must be a whole number from 0 to 65535"));
}

TEST(ServeSettings, AVariableThatIsNoSettingIsReported) {
  const Variable port("VAT_PROT", "1");
  EXPECT_THAT(
      run_vat({"serve", "--print-config"}),
      exits(0, HasSubstr("an environment variable is not a setting: VAT_PROT, not VAT_PORT?")));
}

}  // namespace
}  // namespace vat::test::serve_settings_test

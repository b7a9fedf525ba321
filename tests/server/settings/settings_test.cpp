// Settings from a file, the environment and options, and the document that lists them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "server/settings/serve_settings.h"
#include "server/settings/setting_sources.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::settings_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class Settings : public testing::Test {
 protected:
  Status apply_text(const std::string& text) {
    folder_.write("vat.json", text);
    return apply_file(table, folder_.file("vat.json"), sources);
  }

  ServeSettings target;
  std::vector<Setting> table = serve_settings(target);
  SettingSources sources;

 private:
  TemporaryFolder folder_;
};

std::string read_whole(const std::string& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST_F(Settings, ALaterSourceCountsMore) {
  ASSERT_TRUE(apply_text(R"({"port": 1, "endpoints": 2, "max_sessions": 3})"));
  ASSERT_TRUE(apply_environment(table, {"VAT_PORT=4", "VAT_ENDPOINTS=5", "HOME=/"}, sources));
  apply_options(table, {{"port", "6"}}, sources);
  EXPECT_EQ(target.port, 6);
  EXPECT_EQ(target.endpoints, 5U);
  EXPECT_EQ(target.limits.max_sessions, 3U);
  const Json told = describe(table, sources);
  EXPECT_EQ(told.at("settings").at("port"), 6);
  EXPECT_EQ(told.at("sources").at("port"), "option");
  EXPECT_EQ(told.at("sources").at("endpoints"), "environment");
  EXPECT_THAT(told.at("sources").at("max_sessions").get<std::string>(), HasSubstr("file "));
  EXPECT_EQ(told.at("sources").at("threads"), "default");
}

TEST_F(Settings, ThePrintedSettingsAreAFile) {
  target.limits.max_clients_per_session = 77;
  const Json printed = describe(table, sources).at("settings");
  target = {};
  ASSERT_TRUE(apply_text(printed.dump()));
  EXPECT_EQ(target.limits.max_clients_per_session, 77U);
  EXPECT_EQ(describe(table, sources).at("settings"), printed);
}

TEST_F(Settings, TheFileOfVariablesHasEachSettingAndIsValid) {
  target.limits.max_clients_per_session = 77;
  const std::string file = environment_file(table);
  target = {};
  std::vector<std::string> variables;
  std::istringstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(line.empty() || line.starts_with('#')) << "the file sets nothing: " << line;
    if (line.starts_with("#VAT_")) variables.push_back(line.substr(1));
  }
  EXPECT_EQ(variables.size(), table.size());
  EXPECT_THAT(file, HasSubstr("(0 to 65535).\n#VAT_PORT=8080\n"));
  std::erase_if(variables, [](const std::string& each) { return each.ends_with('='); });
  ASSERT_TRUE(apply_environment(table, variables, sources));
  EXPECT_EQ(target.limits.max_clients_per_session, 77U);
}

TEST_F(Settings, AnUnknownNameHasASuggestionAndTheList) {
  const Status applied = apply_text(R"({"max_conections": 3, "port": 5})");
  ASSERT_FALSE(applied);
  EXPECT_EQ(applied.errors().front().path, "/max_conections");
  EXPECT_THAT(applied.errors().front().message, HasSubstr("did you mean \"max_connections\"?"));
  EXPECT_THAT(applied.errors().front().message, HasSubstr("port, "));
  EXPECT_EQ(target.port, 8080) << "a file with an error sets nothing";
}

TEST_F(Settings, ValuesOutOfRangeNameTheRange) {
  const Status file = apply_text(R"({"port": 70000, "host": 5, "log_level": "loud"})");
  ASSERT_FALSE(file);
  ASSERT_EQ(file.errors().size(), 3U);
  EXPECT_THAT(file.errors()[2].message, HasSubstr("from 0 to 65535"));
  EXPECT_THAT(file.errors()[1].message, HasSubstr("debug, info, warn, error or off"));
  const Status variable = apply_environment(table, {"VAT_PORT=tcp://10.0.0.1:80"}, sources);
  ASSERT_FALSE(variable);
  EXPECT_EQ(variable.errors().front().path, "VAT_PORT");
  EXPECT_THAT(variable.errors().front().message, HasSubstr("from 0 to 65535"));
  for (const char* text : {"[]", "3", "{", ""}) EXPECT_FALSE(apply_text(text)) << text;
  EXPECT_FALSE(apply_file(table, "/no/such/file", sources));
}

TEST_F(Settings, ListsAreSeparatedByCommas) {
  ASSERT_TRUE(apply_text(R"({"public_name": "a.example,b.example:8443",
                             "trusted_proxy": "10.0.0.1,fd00::/8",
                             "allow_origin": "https://a.example,http://b:1"})"));
  EXPECT_THAT(target.public_name, ElementsAre("a.example", "b.example:8443"));
  EXPECT_THAT(target.trusted_proxy, ElementsAre("10.0.0.1", "fd00::/8"));
  EXPECT_THAT(target.allow_origin, ElementsAre("https://a.example", "http://b:1"));
  for (const char* invalid :
       {R"({"public_name": "a.example,https://b.example"})", R"({"public_name": "a,,b"})",
        R"({"public_name": "*.example"})", R"({"trusted_proxy": "10.0.0.1,10.0.0.0/33"})",
        R"({"trusted_proxy": "proxy.example"})", R"({"allow_origin": "https://a.example,*"})"}) {
    const Status applied = apply_text(invalid);
    ASSERT_FALSE(applied) << invalid;
    EXPECT_THAT(applied.errors().front().message, HasSubstr("separated by commas")) << invalid;
  }
  EXPECT_THAT(target.public_name, ElementsAre("a.example", "b.example:8443"));
  ASSERT_TRUE(apply_text(R"({"public_name": ""})"));
  EXPECT_THAT(target.public_name, IsEmpty());
}

// The ends of every range, and one beyond each.
TEST_F(Settings, RangesHoldAtTheirEnds) {
  for (const Setting& setting : table) {
    if (!setting.is_number) continue;
    const std::size_t middle = setting.range.find(" to ");
    const Json min = Json::parse(setting.range.substr(0, middle));
    const Json max = Json::parse(setting.range.substr(middle + 4));
    for (const Json& end : {min, max}) {
      EXPECT_THAT(setting.find_fault(end), IsEmpty()) << setting.name;
      setting.assign(end);
      EXPECT_EQ(setting.value(), end) << setting.name;
    }
    EXPECT_THAT(setting.find_fault(max.get<double>() + 1), HasSubstr("from ")) << setting.name;
    EXPECT_THAT(setting.find_fault(min.get<double>() - 1), HasSubstr("from ")) << setting.name;
    EXPECT_THAT(setting.find_fault("text"), HasSubstr("from ")) << setting.name;
  }
}

TEST_F(Settings, NamesAreOneWordEachAndDiffer) {
  std::set<std::string> names;
  for (const Setting& setting : table) {
    EXPECT_TRUE(names.insert(setting.name).second) << setting.name;
    EXPECT_EQ(setting.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos);
    EXPECT_THAT(setting.find_fault(setting.value()), IsEmpty()) << setting.name;
  }
  EXPECT_EQ(option_of(table.back()).find('_'), std::string::npos);
}

TEST_F(Settings, VariablesThatAreNoSettingAreNamed) {
  EXPECT_THAT(unknown_variables(table, {"VAT_PROT=3", "VAT_PORT=3", "PATH=/bin"}),
              ElementsAre("VAT_PROT, not VAT_PORT?"));
}

TEST_F(Settings, ThePageHasTheExampleAndTheTable) {
  const std::string page = read_whole(VAT_SOURCE_DIR "/server/SETTINGS.md");
  const std::string expected = settings_table(table);
  const std::string shown = page.substr(std::min(page.find("| setting |"), page.size()));
  EXPECT_TRUE(shown == expected) << "the page must end with this:\n" << expected;
  const std::string example = read_whole(VAT_SOURCE_DIR "/docker/vat.json");
  EXPECT_THAT(page, HasSubstr(example));
  EXPECT_TRUE(apply_text(example));
}

}  // namespace
}  // namespace vat::test::settings_test

// protocol/schemas/ has what the server has: methods, and errors.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "protocol/json_reader.h"
#include "server/session/error_table.h"
#include "server/session/method_rules.h"

namespace vat::schemas_test {
namespace {

/// The definitions of a file of schemas; empty where there is none.
Json definitions(const std::string& name) {
  std::ifstream file(VAT_SOURCE_DIR "/protocol/schemas/" + name + ".json");
  return file ? Json::parse(file).at("$defs") : Json::object();
}

std::string group_of(const std::string& method) {
  return method.substr(0, method.find('.'));
}

TEST(Schemas, HaveParamsAndResultOfEveryMethod) {
  for (const MethodRules& rules : method_rules()) {
    const std::string method(rules.method);
    const std::string file = group_of(method);
    EXPECT_TRUE(definitions(file).contains(method + ".params"))
        << "protocol/schemas/" << file << ".json lacks " << method << ".params";
    EXPECT_TRUE(definitions(file).contains(method + ".result"))
        << "protocol/schemas/" << file << ".json lacks " << method << ".result";
  }
}

TEST(Schemas, HaveNoOtherMethods) {
  std::set<std::string> known;
  for (const MethodRules& rules : method_rules()) known.insert(std::string(rules.method));
  const std::filesystem::path folder = VAT_SOURCE_DIR "/protocol/schemas";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const Json file = definitions(entry.path().stem().string());
    for (const auto& [name, definition] : file.items()) {
      if (!name.ends_with(".params")) continue;
      EXPECT_TRUE(known.contains(name.substr(0, name.rfind('.')))) << entry.path() << ": " << name;
    }
  }
}

TEST(Schemas, HaveTheErrorsOfTheTable) {
  const Json errors = definitions("errors");
  std::size_t listed = 0;
  for (const ErrorRow& row : error_rows()) {
    const std::string name(row.name);
    ASSERT_TRUE(errors.contains(name)) << "protocol/schemas/errors.json lacks " << name;
    const Json& properties = errors.at(name).at("properties");
    EXPECT_EQ(properties.at("code").at("const"), row.code) << name;
    EXPECT_EQ(properties.at("data").at("properties").at("kind").at("const"), name);
    for (const Json& choice : errors.at("reply_error").at("oneOf")) {
      if (choice.at("$ref") == "#/$defs/" + name) ++listed;
    }
  }
  EXPECT_EQ(listed, error_rows().size());
  EXPECT_EQ(errors.at("reply_error").at("oneOf").size(), error_rows().size());
}

}  // namespace
}  // namespace vat::schemas_test

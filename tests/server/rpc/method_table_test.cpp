// Compares the method table with the documents and the client's types.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>

#include "protocol/json/json_reader.h"
#include "server/rpc/method_table.h"

namespace vat::test::method_table_test {
namespace {

using Names = std::set<std::string>;

std::string read_file(const std::string& path) {
  std::ifstream file(VAT_SOURCE_DIR "/" + path);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

Names names_of(bool (*has)(const MethodRow&)) {
  Names names;
  for (const Method& method : all_methods()) {
    if (has(method.row)) names.emplace(method.row.name);
  }
  return names;
}

Names all_names() {
  return names_of([](const MethodRow&) { return true; });
}

/// Returns all matches of the first group.
Names matches(const std::string& text, const char* pattern) {
  const std::regex regex(pattern);
  Names names;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match) {
    names.insert((*match)[1]);
  }
  return names;
}

/// Returns the code spans of the line of PROTOCOL.md that starts with `begin`, after this text.
Names documented_methods(const std::string& begin) {
  const std::string text = read_file("protocol/PROTOCOL.md");
  const std::size_t at = text.find('\n' + begin);
  EXPECT_NE(at, std::string::npos) << "protocol/PROTOCOL.md lacks the line: " << begin;
  if (at == std::string::npos) return {};
  const std::size_t after = at + 1 + begin.size();
  return matches(text.substr(after, text.find('\n', after) - after), "`([a-z_]+\\.[a-z_*]+)`");
}

TEST(MethodTable, HasUniqueNames) {
  EXPECT_EQ(all_names().size(), all_methods().size());
}

TEST(MethodTable, AsyncApiHasItsMethods) {
  const Json document = Json::parse(read_file("protocol/asyncapi.json"));
  const Json& messages = document.at("components").at("messages");
  Names operations;
  for (const auto& [name, operation] : document.at("operations").items()) {
    if (operation.at("action") == "receive") operations.insert(name);
  }
  EXPECT_EQ(operations, all_names());
  for (const Method& method : all_methods()) {
    const std::string name(method.row.name);
    const std::string schemas = "schemas/" + method.row.schema_file() + "#/$defs/" + name;
    ASSERT_TRUE(messages.contains(name) && messages.contains(name + ".reply")) << name;
    EXPECT_NE(messages.at(name).dump().find('"' + schemas + ".params\""), std::string::npos);
    EXPECT_NE(messages.at(name + ".reply").dump().find('"' + schemas + ".result\""),
              std::string::npos);
  }
}

TEST(MethodTable, TypesOfTheClientHaveItsMethods) {
  const std::string types = read_file("web/client/protocol.ts");
  const std::size_t begin = types.find("export interface Methods {");
  ASSERT_NE(begin, std::string::npos);
  const std::string methods = types.substr(begin, types.find("\n}", begin) - begin);
  EXPECT_EQ(matches(methods, "\n  '([a-z_.]+)': \\{"), all_names());
}

TEST(MethodTable, ProtocolDescribesItsMethods) {
  const std::string text = read_file("protocol/PROTOCOL.md");
  const Names rows = matches(text, "\n\\| (`[a-z_.`, ]+`) \\|");
  Names described;
  for (const std::string& row : rows) described.merge(matches(row, "`([a-z_]+\\.[a-z_]+)`"));
  for (const std::string& name : all_names()) {
    EXPECT_TRUE(described.contains(name)) << "protocol/PROTOCOL.md has no row of " << name;
  }
}

TEST(MethodTable, LeastRolesAreThoseOfTheProtocol) {
  std::map<std::string, Role> documented;  // by method, or by group such as "grab.*"
  const std::map<std::string, Role> lines{{"| none (not entered) |", Role::none},
                                          {"| `viewer` |", Role::viewer},
                                          {"| `controller` |", Role::controller},
                                          {"| `owner` |", Role::owner},
                                          {"| `admin` |", Role::admin}};
  for (const auto& [line, role] : lines) {
    for (const std::string& name : documented_methods(line)) documented[name] = role;
  }
  for (const Method& method : all_methods()) {
    const std::string name(method.row.name);
    const std::string group = name.substr(0, name.find('.')) + ".*";
    ASSERT_TRUE(documented.contains(name) || documented.contains(group))
        << "protocol/PROTOCOL.md has no role of " << name;
    const Role role = documented.contains(name) ? documented.at(name) : documented.at(group);
    EXPECT_EQ(method.row.least_role, role) << name;
  }
}

TEST(MethodTable, RateClassesAreThoseOfTheProtocol) {
  EXPECT_EQ(documented_methods("| `queries_per_second` |"),
            names_of([](const MethodRow& row) { return row.rate_class == RateClass::query; }));
  EXPECT_EQ(documented_methods("| `pointer_moves_per_second` |"),
            names_of([](const MethodRow& row) { return row.rate_class == RateClass::pointer; }));
  EXPECT_EQ(documented_methods("| `reads_per_second` |"),
            names_of([](const MethodRow& row) { return row.rate_class == RateClass::read; }));
  EXPECT_EQ(documented_methods("| `scenes_per_second` |"),
            names_of([](const MethodRow& row) { return row.rate_class == RateClass::scene; }));
}

TEST(MethodTable, OnlyMethodsOfASessionAreLogged) {
  for (const Method& method : all_methods()) {
    if (!method.row.is_logged()) continue;
    EXPECT_EQ(method.row.role_source, RoleSource::participant) << method.row.name;
    EXPECT_GE(method.row.least_role, Role::controller) << method.row.name;
  }
}

}  // namespace
}  // namespace vat::test::method_table_test

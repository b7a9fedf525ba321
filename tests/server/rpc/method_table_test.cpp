// Compares the method table with the documents and the client's types.

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "protocol/json/json_reader.h"
#include "server/messages/error_table.h"
#include "server/messages/rpc_message.h"
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

TEST(MethodTable, AsyncApiHasItsMethods) {
  const Json document = Json::parse(read_file("protocol/asyncapi.json"));
  const Json& messages = document.at("components").at("messages");
  Names operations;
  for (const auto& [name, operation] : document.at("operations").items()) {
    if (operation.at("action") == "receive") operations.insert(name);
  }
  EXPECT_EQ(operations, all_names());
  EXPECT_EQ(operations.size(), all_methods().size()) << "unique names";
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

// The table of errors, and protocol/schemas/errors.json.

TEST(Schemas, HaveTheErrorsOfTheTable) {
  std::ifstream file(VAT_SOURCE_DIR "/protocol/schemas/errors.json");
  const Json errors = Json::parse(file).at("$defs");
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

/// Returns "code kind hint" of each row of PROTOCOL.md's table of errors.
std::vector<std::string> documented_rows() {
  std::ifstream document(VAT_SOURCE_DIR "/protocol/PROTOCOL.md");
  static const std::regex kRow(R"(\| (-?\d+) \| `(\w+)` \| .* \| (.+) \|)");
  std::vector<std::string> rows;
  std::string line;
  bool inside = false;
  while (std::getline(document, line)) {
    if (line.starts_with("| code | `data.kind`")) inside = true;
    if (inside && line.empty()) break;
    std::smatch cells;
    if (inside && std::regex_match(line, cells, kRow)) {
      rows.push_back(cells.str(1) + ' ' + cells.str(2) + ' ' + cells.str(3));
    }
  }
  return rows;
}

TEST(ErrorTable, IsTheOneOfTheDocument) {
  std::vector<std::string> rows;
  for (const ErrorRow& row : error_rows()) {
    rows.push_back(std::to_string(row.code) + ' ' + std::string(row.name) + ' ' +
                   std::string(row.hint));
  }
  EXPECT_EQ(rows, documented_rows());
}

TEST(ErrorTable, CodesAndNamesAreUnique) {
  std::set<int> codes;
  std::set<std::string_view> names;
  for (const ErrorRow& row : error_rows()) {
    EXPECT_TRUE(codes.insert(row.code).second) << row.code;
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_TRUE(row.hint.ends_with('.')) << row.hint;
  }
}

TEST(ErrorTable, AReplyCarriesTheRowAndThePath) {
  for (const ErrorRow& row : error_rows()) {
    const RpcError error{row.kind, "why", {{"path", "/x"}}};
    const Json data{{"path", "/x"}, {"kind", row.name}, {"hint", row.hint}};
    EXPECT_EQ(Json::parse(write_reply(7, error)),
              Json({{"jsonrpc", "2.0"},
                    {"id", 7},
                    {"error", {{"code", row.code}, {"message", "why"}, {"data", data}}}}));
  }
}

}  // namespace
}  // namespace vat::test::method_table_test

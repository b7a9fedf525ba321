// Compares protocol/schemas/ with the server: methods and errors.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "protocol/json/json_reader.h"
#include "server/messages/error_table.h"
#include "server/messages/rpc_message.h"
#include "server/rpc/method_table.h"

namespace vat::test::schemas_test {
namespace {

/// Returns the definitions of a schema file; empty if there are none.
Json definitions(const std::string& name) {
  std::ifstream file(VAT_SOURCE_DIR "/protocol/schemas/" + name);
  return file ? Json::parse(file).at("$defs") : Json::object();
}

TEST(Schemas, HaveParamsAndResultOfEveryMethod) {
  for (const Method& method : all_methods()) {
    const std::string name(method.row.name);
    const std::string file = method.row.schema_file();
    EXPECT_TRUE(definitions(file).contains(name + ".params"))
        << "protocol/schemas/" << file << " lacks " << name << ".params";
    EXPECT_TRUE(definitions(file).contains(name + ".result"))
        << "protocol/schemas/" << file << " lacks " << name << ".result";
  }
}

TEST(Schemas, HaveNoOtherMethods) {
  std::set<std::string> known;
  for (const Method& method : all_methods()) known.insert(std::string(method.row.name));
  const std::filesystem::path folder = VAT_SOURCE_DIR "/protocol/schemas";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const Json file = definitions(entry.path().filename().string());
    for (const auto& [name, definition] : file.items()) {
      if (!name.ends_with(".params")) continue;
      EXPECT_TRUE(known.contains(name.substr(0, name.rfind('.')))) << entry.path() << ": " << name;
    }
  }
}

TEST(Schemas, HaveTheErrorsOfTheTable) {
  const Json errors = definitions("errors.json");
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
}  // namespace vat::test::schemas_test

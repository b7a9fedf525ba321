#include "server/session/error_table.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "server/session/rpc_message.h"

namespace vat::error_table_test {
namespace {

/// "code kind hint" of each row of PROTOCOL.md's table of errors.
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
}  // namespace vat::error_table_test

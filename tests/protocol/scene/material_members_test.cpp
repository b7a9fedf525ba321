#include "core/scene/material_members.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "protocol/json/json_reader.h"

namespace vat::material_members_test {
namespace {

using testing::HasSubstr;

std::string read_file(const std::string& path) {
  std::ifstream file(VAT_SOURCE_DIR + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string superscript(int exponent) {
  static const char* const kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent))) text += kDigits[digit - '0'];
  return text;
}

/// Formats a number as SCENE.md does: powers of ten above 1000 and below 1/1000 have an exponent.
std::string to_text(Real number) {
  const auto exponent = static_cast<int>(std::lround(std::log10(number)));
  if (number > 0 && std::abs(exponent) > 3) return "10" + superscript(exponent);
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return text;
}

/// Returns the row of a member in SCENE.md.
template <class Part>
std::string row_of(const Member<Part>& member) {
  const Part part;
  std::string standard = "none";
  std::string meaning = member.meaning;
  if (const auto* flag = std::get_if<bool Part::*>(&member.value)) {
    standard = part.**flag ? "`true`" : "`false`";
  } else {
    if (const auto number = member.number_in(part)) standard = to_text(*number);
    if (*member.unit != '\0') meaning += std::string(" [") + member.unit + ']';
    meaning += ", " + to_text(member.min) + " to " + to_text(member.max);
  }
  if (member.is_required) standard = "–";
  if (*member.note != '\0') meaning += std::string("; ") + member.note;
  return std::string("| `") + member.name + "` | " + standard + " | " + meaning + " |";
}

template <class Part>
void expect_rows() {
  const std::string document = read_file("/protocol/SCENE.md");
  for (const Member<Part>& member : kMembersOf<Part>) {
    EXPECT_THAT(document, HasSubstr(row_of(member)));
  }
}

/// Expects range, default and presence of the member in its part of the scene schema.
template <class Part>
void expect_schema(const Json& definitions, const Json& schema) {
  const Part part;
  for (const Member<Part>& member : kMembersOf<Part>) {
    SCOPED_TRACE(member.name);
    Json entry = schema.at("properties").at(member.name);
    if (entry.contains("$ref")) {
      const auto reference = entry["$ref"].get<std::string>();
      entry = definitions.at(reference.substr(reference.rfind('/') + 1));
    }
    const Json required = schema.value("required", Json::array());
    EXPECT_EQ(std::ranges::find(required, member.name) != required.end(), member.is_required);
    if (const auto* flag = std::get_if<bool Part::*>(&member.value)) {
      EXPECT_EQ(entry.at("default"), part.**flag);
      continue;
    }
    EXPECT_EQ(entry.at("minimum").get<Real>(), member.min);
    EXPECT_EQ(entry.at("maximum").get<Real>(), member.max);
    const auto number = member.number_in(part);
    if (number && !member.is_required) {
      EXPECT_EQ(entry.at("default").get<Real>(), *number);
    }
  }
}

TEST(MaterialMembers, AreThoseOfTheDocument) {
  expect_rows<Material>();
  expect_rows<LiquidConstants>();
  expect_rows<Plasticity>();
  expect_rows<Appearance>();
}

TEST(MaterialMembers, AreThoseOfTheSchema) {
  const Json definitions =
      Json::parse(read_file("/protocol/schemas/scene_format.json")).at("$defs");
  const Json& material = definitions.at("material");
  expect_schema<Material>(definitions, material);
  expect_schema<LiquidConstants>(definitions, material.at("properties").at("liquid"));
  expect_schema<Plasticity>(definitions, material.at("properties").at("plasticity"));
  expect_schema<SpringConstants>(definitions, definitions.at("spring_constants"));
  expect_schema<Appearance>(definitions, definitions.at("appearance"));
}

}  // namespace
}  // namespace vat::material_members_test

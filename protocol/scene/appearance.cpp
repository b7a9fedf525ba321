#include "protocol/scene/appearance.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <string_view>

#include "core/scene/material_members.h"

namespace vat {
namespace {

constexpr Colour rgb(std::uint32_t number) {
  return {static_cast<std::uint8_t>(number >> 16), static_cast<std::uint8_t>(number >> 8),
          static_cast<std::uint8_t>(number)};
}

struct KnownLook {
  std::string_view words;  ///< separated by spaces
  std::uint32_t colour;
  Real roughness;
  Real metalness;
  Real opacity;
  Finish finish = Finish::none;
};

/// Looks of liquids. The opacity is used if there is no absorption length.
constexpr std::array kLiquidLooks{
    KnownLook{"honey syrup amber resin", 0xf0a01e, 0.06, 0, 0.85},
    KnownLook{"blood", 0xa80f16, 0.12, 0, 0.97},
    KnownLook{"oil", 0xe8c85a, 0.05, 0, 0.7},
    KnownLook{"milk cream", 0xf6f1e4, 0.2, 0, 1},
    KnownLook{"wax butter", 0xf3dfa6, 0.2, 0, 0.97},
    KnownLook{"lava magma", 0xff5a14, 0.6, 0, 1},
    KnownLook{"mercury gallium", 0xd4d6da, 0.05, 1, 1},
    KnownLook{"ink", 0x1b2a7a, 0.08, 0, 0.99},
    KnownLook{"wine juice", 0x8c1438, 0.05, 0, 0.9},
    KnownLook{"chocolate", 0x4a2616, 0.25, 0, 1},
    KnownLook{"beer cider tea", 0xd9962f, 0.05, 0, 0.75},
    KnownLook{"mud slurry sludge", 0x7a5c3c, 0.6, 0, 1},
    KnownLook{"paint", 0x2f6fd0, 0.2, 0, 1},
    KnownLook{"slime acid", 0x6fcf3c, 0.1, 0, 0.85},
    KnownLook{"water sea brine rain dew", 0x4fb4e0, 0.03, 0, 0.5},
};

/// Looks of solids. A word before another one has priority.
constexpr std::array kSolidLooks{
    KnownLook{"brick", 0xa9523a, 0.9, 0, 1, Finish::brick},
    KnownLook{"clay terracotta pottery", 0xb8623f, 0.85, 0, 1, Finish::clay},
    KnownLook{"wood oak pine beech plank timber crate raft log", 0xb98350, 0.6, 0, 1, Finish::wood},
    KnownLook{"cork", 0xc99a63, 0.95, 0, 1, Finish::clay},
    KnownLook{"rubber tyre tire", 0xc4483a, 0.75, 0, 1, Finish::rubber},
    KnownLook{"steel pump outlet", 0xb9bec4, 0.3, 1, 1, Finish::steel},
    KnownLook{"iron", 0x7f8388, 0.45, 1, 1, Finish::steel},
    KnownLook{"aluminium aluminum tin zinc silver", 0xd3d7da, 0.3, 1, 1, Finish::steel},
    KnownLook{"copper bronze", 0xc97a4a, 0.35, 1, 1, Finish::steel},
    KnownLook{"gold brass", 0xe0b44a, 0.25, 1, 1, Finish::steel},
    KnownLook{"lead", 0x6d7278, 0.5, 1, 1, Finish::steel},
    KnownLook{"stone rock granite concrete boulder", 0x8f8b84, 0.9, 0, 1, Finish::clay},
    KnownLook{"ice", 0xcfe9f5, 0.12, 0, 0.75},
    KnownLook{"glass", 0xd8efe9, 0.04, 0, 0.45},
    KnownLook{"wax candle cheese butter", 0xf0dba4, 0.45, 0, 1},
    KnownLook{"jelly gel gelatine gelatin", 0xd81e4c, 0.12, 0, 0.88},
    KnownLook{"vessel muscle", 0xc2555a, 0.45, 0, 1},
    KnownLook{"tissue skin flesh", 0xe39b92, 0.55, 0, 1},
    KnownLook{"cloth textile canvas sheet fabric", 0xd9c7a3, 0.95, 0, 1},
    KnownLook{"beam", 0x9a6b42, 0.7, 0, 1, Finish::wood},
    KnownLook{"sand", 0xd8bd86, 0.95, 0, 1, Finish::clay},
    KnownLook{"snow foam", 0xf3f6f8, 0.9, 0, 1},
    KnownLook{"leaf plant", 0x5c8f3c, 0.7, 0, 1},
    KnownLook{"plastic", 0x3b82c4, 0.35, 0, 1},
    KnownLook{"soft", 0xe88a4c, 0.5, 0, 1, Finish::rubber},
    KnownLook{"firm", 0x5a7fb0, 0.5, 0, 1, Finish::rubber},
};

/// Returns whether `text` contains `word`, bounded by characters that are not letters. Upper and
/// lower case are equal.
bool has_word(std::string_view text, std::string_view word) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const auto same = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
  for (auto at = text.begin();; ++at) {
    at = std::search(at, text.end(), word.begin(), word.end(), same);
    if (at == text.end()) return false;
    const auto after = at + static_cast<std::ptrdiff_t>(word.size());
    const bool begins = at == text.begin() || !is_letter(*(at - 1));
    if (begins && (after == text.end() || !is_letter(*after))) return true;
  }
}

bool has_one_of(std::string_view text, std::string_view words) {
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    if (has_word(text, words.substr(0, end))) return true;
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return false;
}

template <std::size_t count>
const KnownLook* find_look(const std::array<KnownLook, count>& looks, std::string_view name) {
  const auto found = std::ranges::find_if(
      looks, [&](const KnownLook& look) { return has_one_of(name, look.words); });
  return found == looks.end() ? nullptr : &*found;
}

/// Viscosities [Pa s] from which an unknown liquid looks like oil, and like honey.
constexpr Real kOilViscosity = 20;
constexpr Real kHoneyViscosity = 100;

const KnownLook& liquid_look(const Material& material) {
  if (const KnownLook* look = find_look(kLiquidLooks, material.name)) return *look;
  const Real viscosity = material.liquid->viscosity;
  const char* like = "water";
  if (viscosity >= kOilViscosity) like = "oil";
  if (viscosity >= kHoneyViscosity) like = "honey";
  return *find_look(kLiquidLooks, like);
}

/// Densities [kg/m^3] from which an unknown solid looks like stone, and like steel.
constexpr Real kStoneDensity = 1500;
constexpr Real kSteelDensity = 5000;

const KnownLook& solid_look(const Material& material) {
  if (const KnownLook* look = find_look(kSolidLooks, material.name)) return *look;
  const char* like = "wood";
  if (material.density >= 1000) like = "plastic";
  if (material.density >= kStoneDensity) like = "stone";
  if (material.density >= kSteelDensity) like = "steel";
  if (material.springs) like = material.plasticity ? "clay" : "rubber";
  return *find_look(kSolidLooks, like);
}

std::string to_text(const Colour& colour) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", colour.red, colour.green, colour.blue);
  return text.data();
}

constexpr std::size_t kColourLength = 7;

std::optional<Colour> to_colour(const Json& value, const std::string& path, Errors& errors) {
  const std::string text = value.is_string() ? value.get<std::string>() : "";
  const auto is_digit = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
  if (text.size() == kColourLength && text[0] == '#' &&
      std::all_of(text.begin() + 1, text.end(), is_digit)) {
    return rgb(static_cast<std::uint32_t>(std::stoul(text.substr(1), nullptr, 16)));
  }
  add_error(errors, value.is_string() ? "out_of_range" : "wrong_type", path,
            "must be an sRGB colour from \"#000000\" to \"#ffffff\"");
  return {};
}

}  // namespace

FullAppearance full_appearance(const Material& material) {
  const KnownLook& look = material.liquid ? liquid_look(material) : solid_look(material);
  const Appearance& stated = material.appearance;
  return {stated.colour.value_or(rgb(look.colour)),
          stated.roughness.value_or(look.roughness),
          stated.metalness.value_or(look.metalness),
          stated.opacity.value_or(look.opacity),
          stated.absorption_length,
          stated.finish.value_or(look.finish)};
}

Json write_appearance(const Appearance& appearance) {
  Json json = Json::object();
  for (const Member<Appearance>& member : kMembersOf<Appearance>) {
    if (const auto number = member.number_in(appearance)) json[member.name] = *number;
  }
  if (appearance.colour) json["colour"] = to_text(*appearance.colour);
  if (appearance.finish) json["finish"] = to_string(*appearance.finish);
  return json;
}

Json write_appearance(const FullAppearance& appearance) {
  return write_appearance(Appearance{appearance.colour, appearance.roughness, appearance.metalness,
                                     appearance.opacity, appearance.absorption_length,
                                     appearance.finish});
}

namespace scene_parts {

Appearance to_appearance(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Appearance appearance;
  if (const Json* colour = reader.member("colour")) {
    appearance.colour = to_colour(*colour, reader.path_of("colour"), errors);
  }
  for (const Member<Appearance>& member : kMembersOf<Appearance>) {
    if (!reader.has(member.name)) continue;
    appearance.**std::get_if<std::optional<Real> Appearance::*>(&member.value) =
        reader.real(member.name, member.min, member.max);
  }
  if (reader.has("finish")) {
    appearance.finish = static_cast<Finish>(
        reader.choice("finish", std::span<const char* const>(kNamesOf<Finish>)));
  }
  reader.refuse_unknown();
  return appearance;
}

}  // namespace scene_parts
}  // namespace vat

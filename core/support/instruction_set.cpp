#include "core/support/instruction_set.h"

#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <span>

namespace vat {
namespace {

constexpr std::array kSets = {InstructionSet::baseline, InstructionSet::avx2,
                              InstructionSet::avx512};

bool is_available(InstructionSet set) {
  const std::int64_t targets = HWY_TARGETS & hwy::SupportedTargets();
  switch (set) {
    case InstructionSet::baseline:
      return true;
    case InstructionSet::avx2:
      return (targets & HWY_AVX2) != 0;
    case InstructionSet::avx512:
      return (targets & HWY_AVX3) != 0;
  }
  VAT_CHECK(false && "not an instruction set");
  return false;
}

std::string list(std::span<const InstructionSet> sets) {
  std::string text;
  for (const InstructionSet set : sets) {
    if (!text.empty()) text += ", ";
    text += to_string(set);
  }
  return text;
}

}  // namespace

const char* to_string(InstructionSet set) {
  switch (set) {
    case InstructionSet::baseline:
      return "baseline";
    case InstructionSet::avx2:
      return "avx2";
    case InstructionSet::avx512:
      return "avx512";
  }
  VAT_CHECK(false && "not an instruction set");
  return "";
}

Result<InstructionSet> parse_instruction_set(std::string_view name) {
  const auto set = std::ranges::find(kSets, name, [](InstructionSet s) { return to_string(s); });
  if (set != kSets.end()) return *set;
  return Error{"unknown_name", "", "'" + std::string(name) + "' is not one of " + list(kSets)};
}

std::vector<InstructionSet> available_instruction_sets() {
  std::vector<InstructionSet> sets;
  std::ranges::copy_if(kSets, std::back_inserter(sets), is_available);
  return sets;
}

InstructionSet best_instruction_set() {
  return available_instruction_sets().back();
}

Status check_available(InstructionSet set) {
  if (is_available(set)) return {};
  return Error{"not_available", "",
               std::string("this machine has no ") + to_string(set) +
                   "; the instruction sets are " + list(available_instruction_sets())};
}

}  // namespace vat

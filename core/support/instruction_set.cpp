#include "core/support/instruction_set.h"

#include <hwy/targets.h>

#if HWY_ARCH_X86
#include <cpuid.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <span>

#include "core/support/check.h"
#include "core/support/nearest_name.h"

namespace vat {
namespace {

constexpr std::array kSets = {InstructionSet::baseline, InstructionSet::avx2,
                              InstructionSet::avx512};

// Detection by the compiler's library. Highway's own detection executes, when it is loaded, an
// instruction that valgrind does not know on every processor.
#if HWY_ARCH_X86
// clang 14 has no names for these two.
bool has_lzcnt_and_f16c() {
  constexpr unsigned kFeatures = 1;
  constexpr unsigned kMoreFeatures = 0x80000001;
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (__get_cpuid(kFeatures, &a, &b, &c, &d) == 0 || (c & bit_F16C) == 0) return false;
  return __get_cpuid(kMoreFeatures, &a, &b, &c, &d) != 0 && (c & bit_LZCNT) != 0;
}

bool has_avx2() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
         __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") && has_lzcnt_and_f16c() &&
         __builtin_cpu_supports("aes") && __builtin_cpu_supports("pclmul");
}

bool has_avx512() {
  return has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512vl");
}
#else
bool has_avx2() {
  return false;
}
bool has_avx512() {
  return false;
}
#endif

std::atomic<InstructionSet> greatest_set = InstructionSet::avx512;

bool is_available(InstructionSet set) {
  if (set > greatest_set) return false;
  switch (set) {
    case InstructionSet::baseline:
      return true;
    case InstructionSet::avx2:
      return (HWY_TARGETS & HWY_AVX2) != 0 && has_avx2();
    case InstructionSet::avx512:
      return (HWY_TARGETS & HWY_AVX3) != 0 && has_avx512();
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

void limit_instruction_sets(InstructionSet greatest) {
  greatest_set = greatest;
}

Result<InstructionSet> parse_instruction_set(std::string_view name) {
  const auto set = std::ranges::find(kSets, name, [](InstructionSet s) { return to_string(s); });
  if (set != kSets.end()) return *set;
  return unknown_name({}, "", "'" + std::string(name) + "' is not one of " + list(kSets), name,
                      kSets, [](InstructionSet s) { return to_string(s); });
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

#include "server/settings/setting.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>
#include <utility>

#include "protocol/files/text.h"

namespace vat {
namespace {

constexpr std::size_t kMaxTextBytes = 4096;

std::string fault_of(const Errors& errors) {
  return errors.empty() ? std::string() : errors.front().message;
}

template <class Number>
bool parse_all(const std::string& text, Number& number) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stop == end;
}

std::string number_text(double number) {
  std::string text;
  append_number(text, number);
  return text;
}

std::vector<std::string> split_list(const std::string& list) {
  std::vector<std::string> texts;
  std::istringstream stream(list);
  for (std::string text; std::getline(stream, text, ',');) texts.push_back(text);
  return texts;
}

std::string join_list(const std::vector<std::string>& texts) {
  std::string list;
  for (const std::string& text : texts) list += (list.empty() ? "" : ",") + text;
  return list;
}

Setting begin_setting(std::string name, std::string range, std::string help) {
  Setting setting;
  setting.name = std::move(name);
  setting.help = std::move(help);
  setting.range = std::move(range);
  return setting;
}

Setting begin_number(std::string name, const std::string& min, const std::string& max,
                     std::string help) {
  Setting setting = begin_setting(std::move(name), min + " to " + max, std::move(help));
  setting.is_number = true;
  return setting;
}

}  // namespace

std::string option_of(const Setting& setting) {
  std::string option = "--" + setting.name;
  std::ranges::replace(option, '_', '-');
  return option;
}

std::string variable_of(const Setting& setting) {
  std::string variable = "VAT_";
  for (const char c : setting.name) {
    variable += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return variable;
}

Json to_json(const Setting& setting, const std::string& text) {
  std::uint64_t whole = 0;
  double real = 0;
  if (setting.is_number && parse_all(text, whole)) return whole;
  if (setting.is_number && parse_all(text, real)) return real;
  return text;
}

std::string to_text(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.dump();
}

Setting text_setting(std::string name, std::string& target, std::string what, std::string help,
                     TextCheck check) {
  Setting setting = begin_setting(std::move(name), std::move(what), std::move(help));
  setting.find_fault = [check = std::move(check)](const Json& value) {
    Errors errors;
    const auto text = to_text(value, "", kMaxTextBytes, errors);
    return text && check ? check(*text) : fault_of(errors);
  };
  setting.assign = [&target](const Json& value) { target = value.get<std::string>(); };
  setting.value = [&target] { return target; };
  return setting;
}

Setting list_setting(std::string name, std::vector<std::string>& target, std::string what,
                     std::string help, TextCheck check) {
  Setting setting = begin_setting(std::move(name), std::move(what), std::move(help));
  setting.is_list = true;
  setting.find_fault = [check = std::move(check)](const Json& value) {
    Errors errors;
    const auto list = to_text(value, "", kMaxTextBytes, errors);
    if (!list) return fault_of(errors);
    std::string fault;
    for (const std::string& text : split_list(*list)) {
      if (fault.empty()) fault = check(text);
    }
    return fault;
  };
  setting.assign = [&target](const Json& value) { target = split_list(value.get<std::string>()); };
  setting.value = [&target] { return join_list(target); };
  return setting;
}

Setting word_setting(std::string name, std::string& target, std::vector<std::string> words,
                     std::string help) {
  std::string list;
  for (const std::string& word : words) {
    if (!list.empty()) list += word == words.back() ? " or " : ", ";
    list += word;
  }
  const auto check = [list, words = std::move(words)](const std::string& text) {
    const bool known = std::ranges::find(words, text) != words.end();
    return known ? std::string() : "must be " + list;
  };
  return text_setting(std::move(name), target, list, std::move(help), check);
}

Setting whole_setting(std::string name, std::uint64_t min, std::uint64_t max, std::string help,
                      std::function<void(std::uint64_t)> assign,
                      std::function<std::uint64_t()> value) {
  Setting setting =
      begin_number(std::move(name), std::to_string(min), std::to_string(max), std::move(help));
  setting.find_fault = [min, max](const Json& number) {
    Errors errors;
    to_count(number, "", min, max, errors);
    return fault_of(errors);
  };
  setting.assign = [assign = std::move(assign)](const Json& number) {
    assign(number.get<std::uint64_t>());
  };
  setting.value = [value = std::move(value)] { return value(); };
  return setting;
}

Setting real_setting(std::string name, double min, double max, std::string help,
                     std::function<void(double)> assign, std::function<double()> value) {
  Setting setting =
      begin_number(std::move(name), number_text(min), number_text(max), std::move(help));
  setting.find_fault = [min, max](const Json& number) {
    Errors errors;
    to_real(number, "", min, max, errors);
    return fault_of(errors);
  };
  setting.assign = [assign = std::move(assign)](const Json& number) {
    assign(number.get<double>());
  };
  setting.value = [value = std::move(value)] { return value(); };
  return setting;
}

Setting time_setting(std::string name, std::chrono::seconds& target, std::uint64_t min,
                     std::uint64_t max, std::string help) {
  return whole_setting(
      std::move(name), min, max, std::move(help),
      [&target](std::uint64_t value) {
        target = std::chrono::seconds(static_cast<std::int64_t>(value));
      },
      [&target] { return static_cast<std::uint64_t>(target.count()); });
}

Setting time_setting(std::string name, std::chrono::milliseconds& target, double min, double max,
                     std::string help) {
  return real_setting(
      std::move(name), min, max, std::move(help),
      [&target](double value) { target = std::chrono::milliseconds(std::llround(1000 * value)); },
      [&target] { return std::chrono::duration<double>(target).count(); });
}

}  // namespace vat

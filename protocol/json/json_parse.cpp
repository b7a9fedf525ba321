#include <set>
#include <vector>

#include "protocol/json/json_reader.h"
#include "protocol/json/printable.h"

namespace vat {
namespace {

/// Checks a text without building values, because copying or freeing a deeply nested value
/// overflows the stack. It also detects duplicate keys, which a document does not store.
class LimitCheck final : public nlohmann::json_sax<Json> {
 public:
  explicit LimitCheck(const JsonLimits& limits) : limits_(limits) {}

  const std::optional<Error>& error() const { return error_; }

  bool null() override { return count_value(); }
  bool boolean(bool) override { return count_value(); }
  bool number_integer(number_integer_t) override { return count_value(); }
  bool number_unsigned(number_unsigned_t) override { return count_value(); }
  bool number_float(number_float_t, const string_t&) override { return count_value(); }
  bool string(string_t&) override { return count_value(); }
  bool binary(binary_t&) override { return fail("parse_error", "binary values are not JSON"); }

  bool start_object(std::size_t) override { return open(); }
  bool start_array(std::size_t) override { return open(); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& key) override {
    if (keys_.back().insert(key).second) return true;
    return fail("duplicate_key", "the member " + printable(key) + " is given twice in one object");
  }

  bool parse_error(std::size_t, const std::string&, const Json::exception& exception) override {
    std::string_view reason = exception.what();
    const std::size_t tag_end = reason.find("] ");  // "[json.exception.parse_error.101] ..."
    if (tag_end != std::string_view::npos) reason.remove_prefix(tag_end + 2);
    return fail("parse_error", "not JSON: " + printable(reason));
  }

 private:
  bool fail(std::string code, std::string message) {
    error_ = Error{std::move(code), "", std::move(message)};
    return false;
  }

  bool count_value() {
    if (++values_ <= limits_.values) return true;
    return fail("too_many_values", "at most " + std::to_string(limits_.values) + " values");
  }

  bool open() {
    keys_.emplace_back();
    if (keys_.size() <= limits_.depth) return count_value();
    return fail("too_deep", "nested deeper than " + std::to_string(limits_.depth) + " levels");
  }

  bool close() {
    keys_.pop_back();
    return true;
  }

  JsonLimits limits_;
  std::size_t values_ = 0;
  std::vector<std::set<std::string>> keys_;  // of each open array or object
  std::optional<Error> error_;
};

}  // namespace

Result<Json> parse_json(std::string_view text, const JsonLimits& limits) {
  if (text.size() > limits.bytes) {
    return Error{"too_large", "",
                 "the text has " + std::to_string(text.size()) + " bytes; at most " +
                     std::to_string(limits.bytes) + " are allowed"};
  }
  // The parser stops at a zero byte and would ignore the rest of the text.
  const std::size_t zero = text.find('\0');
  if (zero != std::string_view::npos) {
    return Error{"parse_error", "", "not JSON: zero byte at position " + std::to_string(zero)};
  }
  LimitCheck check(limits);
  if (!Json::sax_parse(text, &check)) {
    VAT_CHECK(check.error().has_value());
    return *check.error();
  }
  return Json::parse(text);
}

}  // namespace vat

#include "protocol/tune/scene_edit.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "core/support/check.h"
#include "protocol/scene/scene_json.h"

namespace vat::tune {
namespace {

/// A member of the root of a document: its key, and the bytes of its value.
struct RootMember {
  std::string key;
  std::size_t begin = 0;
  std::size_t end = 0;
};

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// Scanner of the root members of a valid JSON object.
class RootScanner {
 public:
  explicit RootScanner(std::string_view text) : text_(text) {}

  std::vector<RootMember> members() {
    std::vector<RootMember> found;
    skip_to_next();  // to the brace
    ++at_;
    for (skip_to_next(); text_[at_] != '}'; skip_to_next()) {
      if (text_[at_] == ',') {
        ++at_;
        skip_to_next();
      }
      const std::size_t key = at_;
      skip_value();
      RootMember member{Json::parse(text_.substr(key, at_ - key)).get<std::string>()};
      skip_to_next();  // to the colon
      ++at_;
      skip_to_next();
      member.begin = at_;
      skip_value();
      member.end = at_;
      found.push_back(std::move(member));
    }
    return found;
  }

 private:
  void skip_to_next() {
    at_ = text_.find_first_not_of(" \t\r\n", at_);
    VAT_CHECK(at_ != std::string_view::npos);
  }

  void skip_string() {
    for (++at_; text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\') ++at_;
    }
    ++at_;
  }

  void skip_value() {
    if (text_[at_] == '"') return skip_string();
    int depth = 0;
    do {
      const char c = text_[at_];
      if (c == '"') {
        skip_string();
        continue;
      }
      if (depth == 0 && (c == ',' || c == '}' || is_space(c))) return;
      if (c == '{' || c == '[') ++depth;
      if (c == '}' || c == ']') --depth;
      ++at_;
      if (depth == 0 && (c == '}' || c == ']')) return;
    } while (at_ < text_.size());
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// A new value of a member.
struct Replacement {
  std::string key;
  std::string value;
};

/// Returns a flat object in one line.
std::string object_text(const Json& object, std::initializer_list<const char*> keys) {
  std::string text;
  for (const char* key : keys) {
    if (!object.contains(key)) continue;
    text += (text.empty() ? "{\"" : ", \"") + std::string(key) + "\": " + object.at(key).dump();
  }
  return text + '}';
}

std::vector<Replacement> replacements(const Candidate& candidate, bool has_liquid) {
  const Json written = write_scene(with_candidate(Scene{}, candidate));
  std::vector<Replacement> all{
      {"numerics", object_text(written.at("numerics"),
                               {"integrator", "step", "tick", "control", "tolerance"})}};
  if (!has_liquid) return all;
  all.push_back({"pressure_solver", written.at("pressure_solver").dump()});
  if (candidate.pressure_solver == PressureSolver::incompressible) {
    all.push_back({"incompressible",
                   object_text(written.at("incompressible"),
                               {"density_tolerance", "divergence_tolerance", "most_iterations"})});
  }
  return all;
}

std::vector<RootMember>::const_iterator find_member(const std::vector<RootMember>& members,
                                                    const std::string& key) {
  return std::ranges::find(members, key, &RootMember::key);
}

/// A text that replaces the bytes from `begin` to `end`.
struct Edit {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::string text;
};

std::vector<Edit> find_edits(std::string_view text, const std::vector<RootMember>& members,
                             const std::vector<Replacement>& wanted) {
  std::vector<Edit> edits;
  std::string inserted;
  for (const Replacement& replacement : wanted) {
    const auto member = find_member(members, replacement.key);
    if (member != members.end()) {
      edits.push_back({member->begin, member->end, replacement.value});
    } else {
      inserted += ",\n  \"" + replacement.key + "\": " + replacement.value;
    }
  }
  if (inserted.empty()) return edits;
  const auto numerics = find_member(members, "numerics");
  if (numerics != members.end()) {
    std::ranges::find(edits, numerics->begin, &Edit::begin)->text += inserted;
  } else {
    const std::size_t begin = text.find('{') + 1;
    edits.push_back({begin, begin, inserted.substr(1) + (members.empty() ? "" : ",")});
  }
  return edits;
}

}  // namespace

Result<std::string> with_numerics(std::string_view text, const Candidate& candidate,
                                  bool has_liquid) {
  const Result<Json> document = parse_json(text, kSceneLimits);
  if (!document) return document.errors();
  if (!document.value().is_object()) return Error{"wrong_type", "", "must be an object"};
  const std::vector<RootMember> members = RootScanner(text).members();
  std::vector<Edit> edits = find_edits(text, members, replacements(candidate, has_liquid));
  std::ranges::sort(edits, std::greater{}, &Edit::begin);
  std::string edited(text);
  for (const Edit& edit : edits) edited.replace(edit.begin, edit.end - edit.begin, edit.text);
  return edited;
}

}  // namespace vat::tune

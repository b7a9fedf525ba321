#include "tests/bench/document/markers.h"

#include <algorithm>
#include <optional>
#include <regex>
#include <set>
#include <sstream>

namespace vat::bench {

namespace {

/// Returns NAME of the line `<!-- WORD NAME -->`.
std::optional<std::string> name_in(const std::string& line, const std::string& word) {
  const std::string before = "<!-- " + word + " ";
  const std::string after = " -->";
  if (!line.starts_with(before) || !line.ends_with(after)) return {};
  if (line.size() <= before.size() + after.size()) return {};
  return line.substr(before.size(), line.size() - before.size() - after.size());
}

/// Copies a page line by line, and replaces the text between markers by the contents.
class Filler {
 public:
  explicit Filler(const std::map<std::string, std::string>& contents) : contents_(contents) {}

  void take(const std::string& line) {
    if (const auto begun = name_in(line, "begin")) {
      begin(line, *begun);
    } else if (const auto ended = name_in(line, "end")) {
      end(line, *ended);
    } else if (!open_) {
      text_ += line + '\n';
    }
  }

  Result<std::string> finish() {
    if (open_) fault(*open_, "has a beginning but no end");
    for (const auto& [name, content] : contents_) {
      if (!seen_.contains(name)) fault(name, "has no place in the page");
    }
    if (!errors_.empty()) return errors_;
    return text_;
  }

 private:
  void begin(const std::string& line, const std::string& name) {
    if (open_) fault(name, "begins within " + *open_);
    if (!seen_.insert(name).second) fault(name, "comes twice");
    open_ = name;
    text_ += line + '\n';
    const auto content = contents_.find(name);
    if (content == contents_.end()) return fault(name, "is nothing that can be filled in");
    text_ += content->second;
    if (!text_.ends_with('\n')) text_ += '\n';
  }

  void end(const std::string& line, const std::string& name) {
    if (open_ != name) fault(name, "has an end but no beginning");
    open_.reset();
    text_ += line + '\n';
  }

  void fault(const std::string& name, const std::string& message) {
    errors_.push_back({"bad_marker", name, message});
  }

  const std::map<std::string, std::string>& contents_;
  std::string text_;
  std::optional<std::string> open_;
  std::set<std::string> seen_;
  Errors errors_;
};

}  // namespace

Result<std::string> fill_markers(const std::string& page,
                                 const std::map<std::string, std::string>& contents) {
  Filler filler(contents);
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) filler.take(line);
  return filler.finish();
}

bool has_marker(const std::string& page, const std::string& name) {
  return page.find("<!-- begin " + name + " -->\n") != std::string::npos;
}

std::vector<std::string> pictures_of(const std::string& page) {
  static const std::regex picture(R"(!\[[^\]]*\]\(([^)\s]+)\))");
  std::vector<std::string> targets;
  for (std::sregex_iterator found(page.begin(), page.end(), picture), none; found != none;
       ++found) {
    const std::string target = (*found)[1];
    if (std::ranges::find(targets, target) == targets.end()) targets.push_back(target);
  }
  return targets;
}

}  // namespace vat::bench

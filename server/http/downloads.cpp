#include "server/http/downloads.h"

#include <utility>

#include "core/support/check.h"
#include "server/access/token.h"

namespace vat {

std::optional<std::string> Downloads::add(File file, SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  forget_old_locked(now);
  const std::size_t size = file.content.size();
  if (bytes_ + size > max_bytes_) return {};
  std::string path = std::string(kFolder) + (node_.empty() ? "" : node_ + "/") + make_token();
  bytes_ += size;
  files_.emplace(path, Waiting{std::move(file), now + kPatience});
  return path;
}

std::string Downloads::other_node(std::string_view path) const {
  if (node_.empty() || !path.starts_with(kFolder)) return {};
  path.remove_prefix(kFolder.size());
  const auto end = path.find('/');
  if (end == std::string_view::npos || path.substr(0, end) == node_) return {};
  return std::string(path.substr(0, end));
}

std::optional<Downloads::File> Downloads::take(std::string_view path, SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  forget_old_locked(now);
  const auto found = files_.find(path);
  if (found == files_.end()) return {};
  File file = std::move(found->second.file);
  VAT_CHECK(bytes_ >= file.content.size());
  bytes_ -= file.content.size();
  files_.erase(found);
  return file;
}

std::optional<Downloads::Part> Downloads::read(std::string_view path, std::size_t offset,
                                               std::size_t max_bytes, SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  forget_old_locked(now);
  const auto found = files_.find(path);
  if (found == files_.end() || offset > found->second.file.content.size()) return {};
  const File& file = found->second.file;
  Part part{file.name, file.content.size(), file.content.substr(offset, max_bytes)};
  if (offset + part.content.size() < part.size) return part;
  bytes_ -= part.size;
  files_.erase(found);
  return part;
}

Downloads::Room Downloads::reserve(std::size_t bytes, SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  forget_old_locked(now);
  if (bytes > max_bytes_ - bytes_) return nullptr;
  bytes_ += bytes;
  return Room(this, [bytes](void* downloads) {
    auto& self = *static_cast<Downloads*>(downloads);
    const std::lock_guard release(self.mutex_);
    self.bytes_ -= bytes;
  });
}

std::size_t Downloads::forget_old(SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  forget_old_locked(now);
  return bytes_;
}

void Downloads::forget_old_locked(SteadyClock::time_point now) {
  VAT_CHECK(mutex_.is_held());
  std::erase_if(files_, [&](const auto& entry) {
    if (entry.second.end > now) return false;
    VAT_CHECK(bytes_ >= entry.second.file.content.size());
    bytes_ -= entry.second.file.content.size();
    return true;
  });
}

HttpResponse download_response(Downloads::File file) {
  return {200,
          "application/octet-stream",
          std::move(file.content),
          {{"Cache-Control", "no-store"},
           {"Content-Disposition", "attachment; filename=\"" + file.name + "\""},
           {"X-Content-Type-Options", "nosniff"}}};
}

HttpHandler with_downloads(HttpHandler site, Downloads& downloads, const Clock& clock,
                           FetchDownload fetch) {
  return [site = std::move(site), &downloads, &clock,
          fetch = std::move(fetch)](const HttpRequest& request) {
    const bool is_download =
        request.method == "GET" && request.target.starts_with(Downloads::kFolder);
    if (!is_download) return site(request);
    const std::string node = fetch ? downloads.other_node(request.target) : std::string();
    if (!node.empty()) {
      HttpResponse follows;
      follows.later = [fetch, node, path = std::string(request.target)](
                          std::function<void(HttpResponse)> answer) {
        fetch(node, path, std::move(answer));
      };
      return follows;
    }
    std::optional<Downloads::File> file = downloads.take(request.target, clock.now());
    if (!file) return site(request);
    return download_response(*std::move(file));
  };
}

}  // namespace vat

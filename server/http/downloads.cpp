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
  std::string path = std::string(kFolder) + make_token();
  bytes_ += size;
  files_.emplace(path, Waiting{std::move(file), now + kPatience});
  return path;
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

HttpHandler with_downloads(HttpHandler site, Downloads& downloads, const Clock& clock) {
  return [site = std::move(site), &downloads, &clock](const HttpRequest& request) {
    const bool is_download =
        request.method == "GET" && request.target.starts_with(Downloads::kFolder);
    if (!is_download) return site(request);
    std::optional<Downloads::File> file = downloads.take(request.target, clock.now());
    if (!file) return site(request);
    return HttpResponse{200,
                        "application/octet-stream",
                        std::move(file->content),
                        {{"Cache-Control", "no-store"},
                         {"Content-Disposition", "attachment; filename=\"" + file->name + "\""},
                         {"X-Content-Type-Options", "nosniff"}}};
  };
}

}  // namespace vat

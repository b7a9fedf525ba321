#include "server/http/http_site.h"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "server/http/negotiation.h"
#include "server/http/request_path.h"

namespace vat {

namespace {

constexpr const char* kPlainText = "text/plain; charset=utf-8";
constexpr const char* kJson = "application/json";
constexpr const char* kPrometheusText = "text/plain; version=0.0.4; charset=utf-8";

/// Vite puts a hash of the content into the names of these.
constexpr std::string_view kHashedFolder = "/assets/";

/// The viewer loads only its own files, and connects only to its server. 'self' does not cover ws:
/// in all browsers. The origins that may show the site in a frame follow.
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; worker-src 'self'; connect-src 'self' ws: wss:; "
    "style-src 'self'; img-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'self'";

constexpr const char* kNotBuilt = R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>vat</title>
<h1>The viewer has not been built</h1>
<p>The server is running, but it found no viewer. Stop it and start it with <code>./vat serve</code>,
which builds the viewer first.</p>
</html>
)";

HttpResponse text(int status, std::string message) {
  return {status, kPlainText, std::move(message), {}};
}

/// Returns the encoding of the greatest weight; among equal ones, the shortest content.
Encoding preferred_encoding(const StaticFiles::File& file, std::string_view accept_encoding) {
  Encoding best = Encoding::identity;
  double best_weight = weight_of(best, accept_encoding);
  for (const auto& [encoding, content] : file.contents) {
    const double weight = weight_of(encoding, accept_encoding);
    const bool is_shorter = content.bytes.size() < file.contents.at(best).bytes.size();
    if (weight < best_weight || weight == 0 || (weight == best_weight && !is_shorter)) continue;
    best = encoding;
    best_weight = weight;
  }
  return best;
}

HttpResponse file_response(const StaticFiles::File& file, bool is_hashed,
                           const HttpRequest& request) {
  const Encoding encoding = preferred_encoding(file, request.accept_encoding);
  const StaticFiles::Content& content = file.contents.at(encoding);
  HttpResponse response{200, file.content_type, {}, {{"ETag", content.tag}}};
  response.headers.emplace_back("Cache-Control",
                                is_hashed ? "public, max-age=31536000, immutable" : "no-cache");
  if (file.contents.size() > 1) response.headers.emplace_back("Vary", "Accept-Encoding");
  if (contains_tag(request.if_none_match, content.tag)) {
    response.status = 304;
    return response;
  }
  if (encoding != Encoding::identity) {
    response.headers.emplace_back("Content-Encoding", to_string(encoding));
  }
  response.body = content.bytes;
  return response;
}

HttpResponse viewer_file(const StaticFiles& viewer, const std::string& path,
                         const HttpRequest& request) {
  const bool is_root = path == "/";
  if (const StaticFiles::File* file = viewer.find(is_root ? "/index.html" : path)) {
    return file_response(*file, path.starts_with(kHashedFolder), request);
  }
  if (is_root) return {503, "text/html; charset=utf-8", kNotBuilt, {}};
  return text(404, "Not found.\n");
}

HttpResponse readiness(ServerPhase phase) {
  const std::string body = std::string("{\"status\":\"") + to_string(phase) + "\"}\n";
  return {phase == ServerPhase::ready ? 200 : 503, kJson, body, {}};
}

/// Returns a measurement if the request may read it.
HttpResponse measurement(const SiteSources& sources, std::string_view authorization,
                         const char* type, const std::function<std::string()>& source) {
  if (sources.may_read_metrics(authorization)) return {200, type, source(), {}};
  HttpResponse response = text(401, "The metrics need a token: Authorization: Bearer TOKEN.\n");
  response.headers.emplace_back("WWW-Authenticate", "Bearer");
  return response;
}

HttpResponse answer(const StaticFiles& viewer, const SiteSources& sources,
                    const HttpRequest& request) {
  if (request.method != "GET" && request.method != "HEAD") {
    HttpResponse response = text(405, "Only GET and HEAD are served here.\n");
    response.headers.emplace_back("Allow", "GET, HEAD");
    return response;
  }
  const std::optional<std::string> path = request_path(request.target);
  if (!path) return text(400, "The path is malformed.\n");
  if (*path == "/healthz") {
    const bool is_replaced = sources.phase() == ServerPhase::replaced;
    return {is_replaced ? 503 : 200, kJson, sources.health() + '\n', {}};
  }
  if (*path == "/readyz") return readiness(sources.phase());
  if (*path == "/version") return {200, kJson, sources.version + '\n', {}};
  if (*path == "/metrics") {
    return measurement(sources, request.authorization, kPrometheusText, sources.metrics);
  }
  if (*path == "/slow-ticks") {
    return measurement(sources, request.authorization, kJson, sources.slow_ticks);
  }
  return viewer_file(viewer, *path, request);
}

std::string security_policy(const std::vector<std::string>& framing_origins) {
  std::string policy = kContentSecurityPolicy;
  for (const std::string& origin : framing_origins) policy += ' ' + origin;
  return policy;
}

void add_common_headers(const std::string& policy, HttpResponse& response) {
  bool has_cache_control = false;
  for (const auto& header : response.headers) has_cache_control |= header.first == "Cache-Control";
  if (!has_cache_control) response.headers.emplace_back("Cache-Control", "no-store");
  response.headers.emplace_back("Content-Security-Policy", policy);
  response.headers.emplace_back("X-Content-Type-Options", "nosniff");
  response.headers.emplace_back("Referrer-Policy", "no-referrer");
  response.headers.emplace_back("Cross-Origin-Resource-Policy", "same-origin");
}

}  // namespace

HttpHandler make_http_site(StaticFiles viewer, SiteSources sources) {
  return [files = std::make_shared<const StaticFiles>(std::move(viewer)),
          policy = security_policy(sources.framing_origins),
          source = std::move(sources)](const HttpRequest& request) {
    HttpResponse response = answer(*files, source, request);
    add_common_headers(policy, response);
    return response;
  };
}

}  // namespace vat

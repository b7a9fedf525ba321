#include "server/script/http_fetch.h"

#include <algorithm>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <cctype>

#include "protocol/client/connection/socket_stream.h"

namespace vat::script {
namespace {

namespace http = boost::beast::http;

constexpr int kHttp11 = 11;
constexpr std::uint64_t kMaxBody = std::uint64_t{1} << 30;

std::string in_small_letters(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

Json to_json(const http::response<http::string_body>& response) {
  Json headers = Json::object();
  for (const auto& field : response) {
    headers[in_small_letters(std::string(field.name_string()))] = std::string(field.value());
  }
  Json answer = {
      {"status", response.result_int()}, {"size", response.body().size()}, {"headers", headers}};
  if (headers.value("content-type", "") != "application/octet-stream") {
    answer["text"] = response.body();
  }
  return answer;
}

}  // namespace

Json fetch_http(const client::WebSocketUrl& url, const client::TlsTrust& trust,
                const std::string& path, std::chrono::steady_clock::time_point deadline) {
  client::Operations operations;
  client::SocketStream stream(operations.context(), url, trust);
  stream.open(deadline);
  http::request<http::empty_body> request(http::verb::get, path, kHttp11);
  request.set(http::field::host, url.authority());
  request.set(http::field::connection, "close");
  std::optional<boost::system::error_code> outcome;
  const auto ended = [&](boost::system::error_code failure, std::size_t) { outcome = failure; };
  http::async_write(stream, request, ended);
  operations.finish(stream, outcome, deadline, "the server did not take the HTTP request in time");
  if (*outcome) throw std::runtime_error("the HTTP request failed: " + outcome->message());
  outcome.reset();
  boost::beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.body_limit(kMaxBody);
  http::async_read(stream, buffer, parser, ended);
  operations.finish(stream, outcome, deadline,
                    "the server did not answer the HTTP request in time");
  if (*outcome) throw std::runtime_error("no HTTP answer: " + outcome->message());
  return to_json(parser.get());
}

}  // namespace vat::script

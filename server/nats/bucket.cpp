#include "server/nats/bucket.h"

#include <cstdlib>
#include <utility>

namespace vat {
namespace {

constexpr const char* kOperation = "KV-Operation";

bool is_removal(const std::map<std::string, std::string>& headers) {
  const auto operation = headers.find(kOperation);
  return operation != headers.end() && operation->second != "PUT";
}

}  // namespace

Bucket::Bucket(NatsConnection& connection, const std::string& name, std::chrono::milliseconds life)
    : connection_(connection),
      prefix_("$KV." + name + "."),
      watched_("vat.changed."),
      stream_(connection, {"KV_" + name, prefix_ + ">", life, 1, "vat.changed"}) {}

std::optional<Bucket::Entry> Bucket::get(const std::string& key) {
  auto message = stream_.last(subject(key));
  if (!message || is_removal(message->headers)) return {};
  return Entry{key, std::move(message->data), message->sequence, false};
}

std::vector<Bucket::Entry> Bucket::all() {
  std::vector<Entry> entries;
  for (const std::string& subject : stream_.subjects(prefix_ + ">")) {
    if (auto entry = get(subject.substr(prefix_.size()))) entries.push_back(*std::move(entry));
  }
  return entries;
}

std::vector<Bucket::Entry> Bucket::changes_since(std::uint64_t revision) {
  std::vector<Entry> entries;
  while (auto message = stream_.next(prefix_ + ">", revision + 1)) {
    revision = message->sequence;
    entries.push_back({message->subject.substr(prefix_.size()), std::move(message->data), revision,
                       is_removal(message->headers)});
  }
  return entries;
}

std::uint64_t Bucket::put(const std::string& key, const std::string& value,
                          std::uint64_t revision) {
  return stream_.append(subject(key), value, revision);
}

std::uint64_t Bucket::create(const std::string& key, const std::string& value) {
  const auto message = stream_.last(subject(key));
  if (message && !is_removal(message->headers)) {
    throw NatsError(NatsError::Kind::conflict, key + ": the key exists");
  }
  return put(key, value, message ? message->sequence : kNone);
}

void Bucket::put(const std::string& key, const std::string& value, std::uint64_t revision,
                 std::function<void(Stream::Appended)> done) {
  stream_.append(subject(key), value, revision, {}, std::move(done));
}

void Bucket::put(const std::string& key, const std::string& value,
                 std::function<void(Stream::Appended)> done) {
  stream_.append(subject(key), value, std::move(done));
}

std::uint64_t Bucket::remove(const std::string& key, std::uint64_t revision) {
  return stream_.append(subject(key), {}, revision, {{kOperation, "DEL"}});
}

std::uint64_t Bucket::put_after(const std::string& key, const std::string& value,
                                std::uint64_t last_revision) {
  return stream_.append_after(subject(key), value, last_revision);
}

std::uint64_t Bucket::remove_after(const std::string& key, std::uint64_t last_revision) {
  return stream_.append_after(subject(key), {}, last_revision, {{kOperation, "DEL"}});
}

void Bucket::drop_mark(const std::string& key, std::uint64_t revision) {
  stream_.purge_later(subject(key), revision + 1);
}

void Bucket::purge(const std::string& pattern) {
  stream_.purge(subject(pattern));
}

std::unique_ptr<NatsConnection::Subscription> Bucket::watch(
    std::function<void(const Entry&)> handler) {
  return connection_.subscribe(
      watched_ + prefix_ + ">", [this, handler = std::move(handler)](const NatsMessage& message) {
        Entry entry;
        entry.key = message.subject.substr(watched_.size() + prefix_.size());
        entry.value = message.data;
        entry.is_removed = is_removal(message.headers);
        const auto revision = message.headers.find("Nats-Sequence");
        if (revision != message.headers.end()) {
          entry.revision = std::strtoull(revision->second.c_str(), nullptr, 10);
        }
        handler(entry);
      });
}

}  // namespace vat

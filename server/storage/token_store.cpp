#include "server/storage/token_store.h"

#include <algorithm>

namespace vat {

void TokenStore::add(const StoredToken& token) {
  const std::lock_guard lock(main_->mutex);
  Statement insert = main_->database.prepare(
      "INSERT INTO tokens (hash, role, session, ends, uses) VALUES (?, ?, ?, ?, ?)");
  insert.bind(0, std::span<const std::uint8_t>(token.hash))
      .bind(1, std::string_view(token.role))
      .bind(2, std::string_view(token.session))
      .bind(3, token.ends);
  if (token.uses) insert.bind(4, std::uint64_t{*token.uses});
  insert.run();
}

void TokenStore::set_uses(std::span<const std::uint8_t> hash, std::size_t uses) {
  const std::lock_guard lock(main_->mutex);
  main_->database.prepare("UPDATE tokens SET uses = ? WHERE hash = ?")
      .bind(0, std::uint64_t{uses})
      .bind(1, hash)
      .run();
}

void TokenStore::remove(std::span<const std::uint8_t> hash) {
  const std::lock_guard lock(main_->mutex);
  main_->database.prepare("DELETE FROM tokens WHERE hash = ?").bind(0, hash).run();
}

void TokenStore::remove_session(const std::string& session) {
  const std::lock_guard lock(main_->mutex);
  main_->database.prepare("DELETE FROM tokens WHERE session = ?")
      .bind(0, std::string_view(session))
      .run();
}

void TokenStore::remove_old(double now) {
  const std::lock_guard lock(main_->mutex);
  main_->database.prepare("DELETE FROM tokens WHERE ends <= ?").bind(0, now).run();
}

std::vector<StoredToken> TokenStore::all() {
  const std::lock_guard lock(main_->mutex);
  std::vector<StoredToken> tokens;
  Statement query = main_->database.prepare("SELECT hash, role, session, uses, ends FROM tokens");
  while (query.step()) {
    StoredToken token;
    const std::span<const std::uint8_t> hash = query.bytes(0);
    if (hash.size() != token.hash.size()) {
      throw StorageError(StorageError::Kind::corrupt, "a stored token: its hash");
    }
    std::ranges::copy(hash, token.hash.begin());
    token.role = query.text(1);
    token.session = query.text(2);
    if (!query.is_null(3)) token.uses = static_cast<std::size_t>(query.count(3));
    token.ends = query.real(4);
    tokens.push_back(std::move(token));
  }
  return tokens;
}

}  // namespace vat

#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace vat {

/// Counter of items per network address. Thread-safe.
class AddressCounts {
 public:
  struct Held;
  /// One counted item. The item is counted until the last copy is destroyed. Null: refused.
  using Place = std::shared_ptr<Held>;

  /// Adds an item of the address. Returns null if the address already has `most` items.
  Place take(const std::string& address, std::size_t most) {
    const std::lock_guard lock(table_->mutex);
    std::size_t& count = table_->counts[address];
    if (count >= most) {
      if (count == 0) table_->counts.erase(address);
      return nullptr;
    }
    const auto place = std::make_shared<Held>(table_, address);
    ++count;
    return place;
  }

 private:
  struct Table {
    std::mutex mutex;
    std::map<std::string, std::size_t> counts;
  };
  std::shared_ptr<Table> table_ = std::make_shared<Table>();

 public:
  struct Held {
    Held(std::shared_ptr<Table> table_in, std::string address_in)
        : table(std::move(table_in)), address(std::move(address_in)) {}
    ~Held() {
      const std::lock_guard lock(table->mutex);
      const auto entry = table->counts.find(address);
      if (--entry->second == 0) table->counts.erase(entry);
    }
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;

    const std::shared_ptr<Table> table;  // a Place may outlive the AddressCounts
    const std::string address;
  };
};

}  // namespace vat

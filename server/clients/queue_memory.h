#pragma once

#include <cstddef>
#include <string>
#include <unordered_set>

namespace vat {

/// Memory of messages that wait for clients. Texts and frames that several clients share count
/// once.
class QueueMemory {
 public:
  void add(std::size_t bytes) { bytes_ += bytes; }
  void add_shared(const std::string& text) {
    if (counted_.insert(&text).second) bytes_ += text.size();
  }
  std::size_t bytes() const { return bytes_; }

 private:
  std::size_t bytes_ = 0;
  std::unordered_set<const std::string*> counted_;
};

}  // namespace vat

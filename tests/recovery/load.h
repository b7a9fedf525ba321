#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "tests/recovery/client.h"

namespace vat::test {

/// A state that a client received: its hash at a position of a session's history.
struct Seen {
  std::string session;
  std::uint64_t position = 0;
  std::string hash;
};

/// A successful command, which must be in the log.
struct Answered {
  std::string session;
  std::string method;
  std::string params;  ///< as in the log
};

/// Results that clients received from one server process.
class Told {
 public:
  void add(Seen seen);
  void add(Answered answered);
  void add_fault(const std::string& fault);
  std::vector<Seen> seen() const;
  std::vector<Answered> answered() const;
  std::size_t answer_count() const;  ///< of both kinds
  std::vector<std::string> faults() const;

 private:
  mutable std::mutex mutex_;
  std::vector<Seen> seen_;
  std::vector<Answered> answered_;
  std::vector<std::string> faults_;
};

/// Connects. Throws Gone if the connection fails.
WaitingClient connect(std::uint16_t port);

/// Joins a session and sends commands, each after the reply to the previous one, until the
/// connection ends. `name` is unique and makes the sent values unique.
void load_session(WaitingClient client, const std::string& session, std::uint64_t name, Told& told);

/// Creates a session and returns its id. Throws if that fails.
std::string create_session(std::uint16_t port, const std::string& name, const std::string& scene);
/// Returns {id: name} of the running sessions after all are recovered.
std::vector<std::pair<std::string, std::string>> list_sessions(std::uint16_t port);

}  // namespace vat::test

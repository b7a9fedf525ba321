#pragma once

#include <cstdint>
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

/// Results that clients received from one server process. The lists are complete after the clients
/// have ended.
class Told {
 public:
  void add(Seen one);
  void add(Answered one);
  void add_fault(const std::string& fault);
  std::size_t answer_count() const;  ///< of both kinds

  std::vector<Seen> seen;
  std::vector<Answered> answered;
  std::vector<std::string> faults;

 private:
  mutable std::mutex mutex_;
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

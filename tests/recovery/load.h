#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace vat::test {

/// A state that a client was told of: its hash at a position of a session's history.
struct Seen {
  std::string session;
  std::uint64_t position = 0;
  std::string hash;
};

/// A command that was answered with success, and so must be in the log.
struct Answered {
  std::string session;
  std::string method;
  std::string params;  ///< as the log has them
};

/// What clients were told in one life of a server.
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

/// Joins a session of the server at a port and gives commands all the time, one after the other's
/// answer, until the connection breaks. What it sends differs from what anybody else sends: `name`
/// is its own.
void load_session(std::uint16_t port, const std::string& session, std::uint64_t name, Told& told);

/// Creates a session; its id. Throws where that fails.
std::string create_session(std::uint16_t port, const std::string& name, const std::string& scene);
/// {id: name} of the sessions that run, once all have come back.
std::vector<std::pair<std::string, std::string>> list_sessions(std::uint16_t port);

}  // namespace vat::test

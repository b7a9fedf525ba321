#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace vat::bench {

using LoadClock = std::chrono::steady_clock;

enum class ViewerKind : std::uint8_t {
  plain,     ///< reads all and acknowledges every frame
  half,      ///< reads half of the full rate
  stalled,   ///< stops reading after some frames
  restless,  ///< leaves after about a second, and returns
  reader,    ///< as `plain`, and requests the state at the permitted rate
  silent,    ///< joins and never reads
};
inline constexpr std::size_t kViewerKinds = 6;
const char* name_of(ViewerKind kind);

/// Measurements of the viewers of a kind.
struct Sightings {
  std::uint64_t frames = 0;
  std::uint64_t bytes = 0;
  std::uint64_t joins = 0;
  std::uint64_t closed = 0;         ///< closed by the server
  std::vector<float> ages;          ///< [s] of each frame when its last byte was read
  std::vector<float> first_frames;  ///< [s] from subscription to first frame
};

/// Settings of all viewers of a process.
struct LoadSettings {
  std::uint16_t port = 0;
  double max_error = 0;              ///< [m] maximum error that each viewer requests
  double half_bytes_per_second = 0;  ///< rate at which `half` reads
  std::string session = "s1";
  int niceness = 0;  ///< of the process, 0 to 19; 19 is the lowest priority
};

/// A WebSocket of a viewer with minimal cost: it reads only the first bytes of frames, discards the
/// others in the kernel, and never waits.
class Viewer {
 public:
  Viewer(ViewerKind kind, const LoadSettings& settings, std::uint32_t seed);
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// Connects, or reconnects, and requests the upgrade. Throws std::runtime_error if the system
  /// refuses.
  void connect();
  int socket() const { return socket_; }
  /// Reads the available data. Returns false if the viewer pauses reading.
  bool read(Sightings& sightings);
  /// Handles timeouts, called frequently. Returns true if the viewer has a new socket or may read
  /// again.
  bool look_at_clock(LoadClock::time_point now, Sightings& sightings);
  /// Returns whether a frame has arrived since the last connect. A silent viewer returns true if it
  /// has requested to join.
  bool has_frame() const { return has_frame_; }
  ViewerKind kind() const { return kind_; }

 private:
  enum class Stage { closed, upgrading, open };
  void reset();
  void send_text(const std::string& text);
  void send_all(const std::string& bytes);
  void take(const char* bytes, std::size_t size, Sightings& sightings);
  std::size_t take_reply(const char* bytes, std::size_t size);
  std::size_t take_head(const char* bytes, std::size_t size);
  void end_message(Sightings& sightings);
  void end_frame(Sightings& sightings);
  std::size_t readable_now(std::size_t wanted);
  void lose(Sightings& sightings);

  const ViewerKind kind_;
  const LoadSettings& settings_;
  std::mt19937 random_;
  int socket_ = -1;
  Stage stage_ = Stage::closed;
  bool has_frame_ = false;
  int frames_ = 0;  // since the last connect
  LoadClock::time_point subscribed_;
  LoadClock::time_point leaves_;
  LoadClock::time_point next_request_;

  std::string reply_;                     // received part of the reply to the upgrade
  std::array<unsigned char, 14> head_{};  // head of the current message
  std::size_t head_size_ = 0;
  std::uint64_t left_ = 0;  // bytes of its payload that have not arrived
  std::uint64_t size_ = 0;  // size of its payload
  int opcode_ = 0;
  std::array<char, 128> start_{};  // start of its payload
  std::size_t start_size_ = 0;

  double allowance_ = 0;  // [bytes] that a half-speed reader may read at present
  LoadClock::time_point allowed_;
};

}  // namespace vat::bench

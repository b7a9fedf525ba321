// Prints the centre of mass of a body of a running session: watcher BODY URL

#include <protocol/client/client.h>

#include <exception>
#include <future>
#include <iostream>
#include <stdexcept>
#include <string>

using vat::Vec3;
using vat::client::Client;
using vat::client::Frame;

namespace {

constexpr int kFrames = 5;

/// All particles of a liquid or deformable body have about the same mass.
Vec3 find_center_of_mass(const Frame::Body& body) {
  if (body.kind == vat::client::BodyKind::rigid) return body.center_of_mass;
  Vec3 sum = Vec3::Zero();
  for (const Vec3& position : body.positions) sum += position;
  return sum / static_cast<double>(body.positions.size());
}

void watch(const std::string& name, const std::string& url) {
  std::promise<void> done;
  int count = 0;
  vat::client::Handlers handlers;
  handlers.on_frame = [&](const Frame& frame) {
    for (const Frame::Body& body : frame.bodies) {
      if (body.name != name || count == kFrames) continue;
      std::cout << name << " at " << find_center_of_mass(body).transpose() << " m\n";
      if (++count == kFrames) done.set_value();
    }
  };
  Client client(url, {}, handlers);
  client.call<vat::client::SessionJoin>({.name = "watcher"}).get();
  client.call<vat::client::FramesSubscribe>({.max_error = 0.001}).get();
  done.get_future().wait();
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 3) throw std::invalid_argument("usage: watcher BODY URL");
  watch(arguments[1], arguments[2]);
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}

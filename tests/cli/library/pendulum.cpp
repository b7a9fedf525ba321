// A pendulum, which the program simulates, hits a wooden ball, which the library simulates.

#include <core/coupling/coupled_simulation.h>

#include <cmath>
#include <iostream>
#include <memory>

namespace {

constexpr double kMass = 2;
constexpr double kLength = 0.5;
constexpr double kGravity = 9.81;

class Pendulum : public vat::ExternalBody {
 public:
  void start(double, const vat::BodyView&, vat::BodyMotion& motion) override { write(motion); }

  void advance(const vat::CouplingInterval& interval, const vat::ReceivedImpulses& impulses,
               vat::BodyMotion& motion) override {
    push(impulses.linear / 2);
    constexpr int kSteps = 10;
    for (int n = 0; n < kSteps; ++n) {
      rate_ -= kGravity / kLength * std::sin(angle_) * interval.length() / kSteps;
      angle_ += rate_ * interval.length() / kSteps;
    }
    push(impulses.linear / 2);
    write(motion);
  }

 private:
  void push(const vat::Vec3& impulse) {
    rate_ += impulse.dot(vat::Vec3(std::cos(angle_), 0, std::sin(angle_))) / (kMass * kLength);
  }
  void write(vat::BodyMotion& motion) const {
    const double speed = kLength * rate_;
    motion.pose->center_of_mass = kLength * vat::Vec3(std::sin(angle_), 0, -std::cos(angle_));
    motion.pose->velocity = speed * vat::Vec3(std::cos(angle_), 0, std::sin(angle_));
  }

  double angle_ = -0.8;  // from the vertical
  double rate_ = 0;
};

}  // namespace

int main() {
  vat::Scene scene;
  scene.gravity.setZero();
  scene.default_interface = {.stiffness = 5000, .damping = 0};
  scene.materials = {{.name = "wood", .density = 600}};
  vat::BodyDescription bob;
  bob.name = "bob";
  bob.kind = vat::BodyKind::rigid;
  bob.material = "wood";
  bob.shape = vat::SphereShape{.radius = 0.1};
  bob.spacing = 0.05;
  bob.mass = kMass;
  vat::BodyDescription ball = bob;
  ball.name = "ball";
  ball.position = {0.25, 0, -kLength};
  scene.bodies = {bob, ball};

  vat::Result<vat::Simulation> created = vat::Simulation::create(scene);
  if (!created) return 1;
  vat::CoupledSimulation coupled(std::move(created).value());
  const vat::BodyId id = coupled.simulation().find_body("bob").value();
  if (!coupled.attach(id, std::make_unique<Pendulum>())) return 1;
  if (!coupled.advance(1000)) return 1;
  // The pendulum arrives with sqrt(2 g l (1 - cos 0.8)) = 1.72 m/s, and the ball takes most of it.
  const double speed = coupled.simulation().bodies()[1].pose->velocity.x();
  std::cout << "the ball has " << std::round(100 * speed) / 100 << " m/s\n";
}

// Decisions of an owner, and requests for control.

#include "tests/server/fixture/access_fixture.h"

namespace vat::test::session_people_test {
namespace {

constexpr std::uint16_t kKicked = 4003;

class SessionPeople : public AccessTest {
 protected:
  void SetUp() override {
    owner_ = owner();
    owner_->result("control.pause");
    controller_ = invited(*owner_, "controller");
    controller_number_ = joined.at("participant");
    viewer_ = invited(*owner_, "viewer");
    viewer_number_ = joined.at("participant");
    viewer_resume_ = joined.at("resume");
  }
  static Json role_of_params(std::uint64_t number, const std::string& role) {
    return {{"participant", number}, {"role", role}};
  }

  std::unique_ptr<TestClient> owner_, controller_, viewer_;
  std::uint64_t controller_number_ = 0, viewer_number_ = 0;
  std::string viewer_resume_;
};

TEST_F(SessionPeople, AnOwnerGivesAndTakesRoles) {
  EXPECT_EQ(viewer_->error("control.pause").at("code"), 1006);
  owner_->result("participant.set_role", role_of_params(viewer_number_, "controller"));
  viewer_->result("control.pause");
  owner_->result("participant.set_role", role_of_params(viewer_number_, "viewer"));
  EXPECT_EQ(viewer_->error("control.pause").at("data").at("role"), "viewer");
  const Json error = owner_->error("participant.set_role", role_of_params(99, "viewer"));
  EXPECT_EQ(error.at("data").at("path"), "/participant");
}

TEST_F(SessionPeople, AnOwnerStaysOneUntilAnotherIs) {
  const std::uint64_t number = owner_->result("session.join", {{"session", own}}).at("participant");
  EXPECT_EQ(role_of(*owner_), "owner") << "the creator is owner again";
  EXPECT_EQ(owner_->error("participant.set_role", role_of_params(number, "viewer")).at("code"),
            1006);
  EXPECT_EQ(owner_->error("participant.kick", {{"participant", number}}).at("code"), 1006);
  owner_->result("participant.set_role", role_of_params(controller_number_, "owner"));
  EXPECT_EQ(role_of(*controller_), "owner");
  EXPECT_EQ(role_of(*owner_), "controller");
  owner_->result("session.leave");
  EXPECT_EQ(owner_->result("session.join", {{"session", own}}).at("role"), "controller")
      << "the creator does not become owner again";
}

TEST_F(SessionPeople, AnAdminIsAboveTheOwner) {
  const std::uint64_t number = admin->result("session.join", {{"session", own}}).at("participant");
  EXPECT_EQ(owner_->error("participant.set_role", role_of_params(number, "viewer")).at("code"),
            1006);
  EXPECT_EQ(owner_->error("participant.kick", {{"participant", number}}).at("code"), 1006);
  admin->result("participant.set_role", role_of_params(viewer_number_, "owner"));
  EXPECT_EQ(role_of(*viewer_), "owner");
  EXPECT_EQ(role_of(*owner_), "controller");
}

TEST_F(SessionPeople, ControlIsAskedForAndHandedOver) {
  for (TestClient* client : {owner_.get(), controller_.get(), viewer_.get()}) client->mark();
  viewer_->result("control.request");
  for (TestClient* client : {owner_.get(), controller_.get()}) {
    EXPECT_EQ(client->wait_event("control.requested").at("participant"), viewer_number_);
  }
  const std::uint64_t grab = controller_->grab(3);
  controller_->result("control.hand_over", {{"participant", viewer_number_}});
  viewer_->result("control.pause");
  EXPECT_TRUE(viewer_->events("control.requested").empty()) << "a viewer cannot grant control";
  EXPECT_EQ(role_of(*controller_), "viewer");
  EXPECT_EQ(viewer_->error("grab.end", {{"grab", grab}}).at("code"), -32602)
      << "the grab has ended";
  EXPECT_EQ(viewer_->error("control.request").at("code"), 1006)
      << "the participant already has control";
}

TEST_F(SessionPeople, AnOwnerKeepsTheGrantedRole) {
  owner_->result("control.hand_over", {{"participant", viewer_number_}});
  EXPECT_EQ(role_of(*owner_), "owner");
  EXPECT_EQ(owner_->error("control.hand_over", {{"participant", viewer_number_}}).at("code"), 1006);
}

TEST_F(SessionPeople, AKickEndsTheParticipantAndItsToken) {
  const std::uint64_t grab = controller_->grab(3);
  owner_->result("participant.kick", {{"participant", controller_number_}, {"reason", "enough"}});
  controller_->wait_closed();
  EXPECT_EQ(controller_->connection->close_code(), kKicked);
  EXPECT_EQ(owner_->error("grab.end", {{"grab", grab}}).at("code"), -32602);

  owner_->result("participant.kick", {{"participant", viewer_number_}});
  EXPECT_EQ(connect()->error("access.enter", {{"token", viewer_resume_}}).at("code"), 1007);
  const auto other = enter(ticket({{"role", "viewer"}}));
  const Json again = other->result("session.join", {{"session", own}, {"resume", viewer_resume_}});
  EXPECT_EQ(again.at("resumed"), false);
}

TEST_F(SessionPeople, ALockedSessionLetsInTheOwnersGuestsAndAdminsOnly) {
  const std::string before = owner_->result("session.invite", {{"role", "viewer"}}).at("token");
  const Json settings =
      owner_->result("session.configure", {{"locked", true}, {"name", "private"}});
  EXPECT_EQ(settings.at("locked"), true);
  EXPECT_EQ(viewer_->wait_event("session.configured").at("name"), "private");
  const auto stranger = enter(ticket({{"role", "controller"}}));
  EXPECT_EQ(stranger->error("session.join", {{"session", own}}).at("code"), 1006);
  EXPECT_EQ(stranger->error("session.hash").at("code"), 1001) << "the client is in no session";
  const Json list = admin->result("session.list").at("sessions");
  EXPECT_EQ(list.at(1).at("clients"), 3) << "the client is not counted";
  EXPECT_EQ(list.at(1).at("name"), "private");

  enter(before)->result("session.join");
  invited(*owner_, "viewer");
  admin->result("session.join", {{"session", own}});
  viewer_->disconnect();
  const auto back = enter(viewer_resume_);
  EXPECT_EQ(back->result("session.join", {{"resume", viewer_resume_}}).at("resumed"), true);
  owner_->result("session.configure", {{"locked", false}});
  stranger->result("session.join", {{"session", own}});
}

TEST_F(SessionPeople, TheUsualRoleIsTheOwnersToSay) {
  auto guest = enter(viewer_resume_);  // admits without a separate role
  EXPECT_EQ(guest->result("session.join").at("role"), "viewer");
  owner_->result("session.configure", {{"default_role", "controller"}});
  EXPECT_EQ(guest->result("session.join").at("role"), "controller");
  EXPECT_EQ(owner_->error("session.configure", {{"default_role", "owner"}}).at("code"), -32602);
}

}  // namespace
}  // namespace vat::test::session_people_test

// The description of a session in replies to session.join and in the event session.description.

#include "tests/server/fixture/session_fixture.h"

namespace vat::test::session_description_test {
namespace {

class SessionDescription : public SessionTest {
 protected:
  static Json without_tick(Json description) {
    description.erase("tick");
    return description;
  }
  Json join_again() { return without_tick(client->result("session.join").at("description")); }
};

TEST_F(SessionDescription, IsTheSameInTheReplyAndInTheEvent) {
  client->result("world.set_gravity", {{"gravity", {0, 0, -1}}});
  Json told = without_tick(client->wait_event("session.description"));
  EXPECT_EQ(told, join_again());
  EXPECT_EQ(told.at("bodies").size(), 3U);
  client->mark();
  client->result("world.remove_body", {{"body", 2}});
  told = without_tick(client->wait_event("session.description"));
  EXPECT_EQ(told, join_again());
  EXPECT_EQ(told.at("bodies").size(), 2U);
}

TEST_F(SessionDescription, IsStoredOnceForAllJoinsOfAnEpoch) {
  const auto first = join();
  const auto second = join();
  ASSERT_FALSE(first->connection->tails().empty());
  EXPECT_EQ(first->connection->tails().front(), second->connection->tails().front());
  client->result("world.set_gravity", {{"gravity", {0, 0, -1}}});
  const auto third = join();
  EXPECT_EQ(first->connection->tails().front(), third->connection->tails().front());
  client->result("world.remove_body", {{"body", 2}});
  const auto fourth = join();
  EXPECT_NE(first->connection->tails().front(), fourth->connection->tails().front());
  first->wait_event("session.description");
  second->wait_event("session.description");
  server.flush();
  EXPECT_EQ(first->connection->tails().back(), second->connection->tails().back()) << "the event";
}

}  // namespace
}  // namespace vat::test::session_description_test

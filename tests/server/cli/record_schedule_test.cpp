#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "server/cli/record/record_run.h"
#include "server/cli/simulate/simulate_progress.h"

// Times of the frames of a recording, and the text of the remaining time.

namespace vat::test::record_schedule_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(FrameSchedule, HasWholeStepsBetweenFrames) {
  const Schedule schedule = make_frame_schedule(0.001, 0.02, 20).value();
  EXPECT_EQ(schedule.step, 0.001);
  EXPECT_EQ(schedule.steps_per_output, 20U);
  EXPECT_EQ(schedule.total_steps, 20'000U);
  EXPECT_THAT(schedule.notices, IsEmpty());
}

// An interrupted recording can thus be resumed with another end.
TEST(FrameSchedule, StepDoesNotDependOnTheEnd) {
  for (const Real until : {0.0, 0.03, 1.0, 1.01, 7.77}) {
    const Schedule schedule = make_frame_schedule(0.002, 0.03, until).value();
    EXPECT_EQ(schedule.step, 0.002) << until;
    EXPECT_EQ(schedule.steps_per_output, 15U) << until;
    EXPECT_EQ(schedule.total_steps % 15, 0U) << until;
    const Real end = schedule.step * static_cast<Real>(schedule.total_steps);
    EXPECT_LE(end, until + 1e-9);
    EXPECT_GT(end, until - 0.03 - 1e-9);
  }
}

TEST(FrameSchedule, DeviationsAreNoticed) {
  EXPECT_THAT(make_frame_schedule(0.002, 0.03, 0.1).value().notices,
              ElementsAre(HasSubstr("ends at 0.09 s")));
  EXPECT_THAT(make_frame_schedule(0.002, 0.005, 0.1).value().notices,
              ElementsAre(HasSubstr("the step is")));
}

TEST(FrameSchedule, NumberOfFramesIsLimited) {
  EXPECT_TRUE(make_frame_schedule(0.01, 0.01, 9999.99).ok());
  EXPECT_EQ(make_frame_schedule(0.01, 0.01, 10'000).errors()[0].path, "--every");
}

TEST(DurationText, HasTwoUnits) {
  using Seconds = std::chrono::duration<double>;
  EXPECT_EQ(duration_text(Seconds(0)), "0 s");
  EXPECT_EQ(duration_text(Seconds(58.2)), "59 s");
  EXPECT_EQ(duration_text(Seconds(59.5)), "1 min 0 s");
  EXPECT_EQ(duration_text(Seconds(200)), "3 min 20 s");
  EXPECT_EQ(duration_text(Seconds(7500)), "2 h 5 min");
}

}  // namespace
}  // namespace vat::test::record_schedule_test

#include "protocol/recording/recording_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "protocol/recording/recording_writer.h"
#include "server/recording/resume_state.h"
#include "tests/support/scenes.h"
#include "tests/support/temporary_folder.h"

// Recordings and states of interrupted recordings on the disk.

namespace vat::test::recording_file_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

using Bytes = std::vector<std::uint8_t>;

Simulation make_simulation() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.01);
  scene.gravity = Vec3(0, 0, -10);
  scene.materials = {make_material("rubber")};
  scene.bodies = {make_body("pair", BodyKind::deformable, "rubber",
                            make_particles({Vec3(0, 0, 0), Vec3(1, 0, 0)}, 1), 0.05)};
  return Simulation::create(scene).value();
}

class RecordingFileTest : public testing::Test {
 protected:
  /// Writes a recording and returns its bytes.
  std::string write(std::size_t frames) {
    Simulation simulation = make_simulation();
    FrameRecorder recorder({0.01, std::nullopt, 3});
    Result<RecordingWriter> writer = RecordingWriter::create(name);
    EXPECT_TRUE(writer.ok());
    for (std::size_t f = 0; f < frames; ++f) {
      EXPECT_TRUE(writer.value().write(recorder.record(simulation)).ok());
      simulation.advance(1);
    }
    EXPECT_TRUE(writer.value().finish().ok());
    return content();
  }
  std::string content() const {
    std::ifstream file(name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  Error error_of_open() const {
    const Result<RecordingFile> file = RecordingFile::open(name);
    EXPECT_FALSE(file.ok());
    return file ? Error{} : file.errors()[0];
  }

  TemporaryFolder folder;
  const std::string name = folder.file("a.vatrec");
};

TEST_F(RecordingFileTest, HasDescriptionAndFrames) {
  const std::string bytes = write(7);
  Result<RecordingFile> file = RecordingFile::open(name);
  ASSERT_TRUE(file.ok()) << file.errors()[0].message;
  EXPECT_EQ(file.value().size(), bytes.size());
  EXPECT_EQ(file.value().index().frames().size(), 7U);
  EXPECT_THAT(file.value().description(0).value(), HasSubstr("\"tick_seconds\":0.01"));
  FrameDecoder decoder;
  for (std::size_t f = 0; f < 7; ++f) {
    const Result<const GridFrame*> frame = decoder.decode(file.value().frame(f).value());
    ASSERT_TRUE(frame.ok()) << frame.errors()[0].message;
    EXPECT_EQ(frame.value()->header.tick, f);
  }
  EXPECT_THAT(folder.names(), ElementsAre("a.vatrec"));
}

TEST_F(RecordingFileTest, IsUnderAPartialNameUntilItIsFinished) {
  {
    Simulation simulation = make_simulation();
    FrameRecorder recorder({0.01, std::nullopt, 3});
    Result<RecordingWriter> writer = RecordingWriter::create(name);
    ASSERT_TRUE(writer.value().write(recorder.record(simulation)).ok());
  }
  EXPECT_THAT(folder.names(), ElementsAre("a.vatrec.part"));
}

TEST_F(RecordingFileTest, CopyOfAPartEqualsAShorterRecording) {
  for (const std::size_t count : {1U, 4U, 7U}) {
    const std::string expected = write(count);
    write(7);
    Result<RecordingFile> file = RecordingFile::open(name);
    ASSERT_TRUE(file.ok());
    Result<RecordingWriter> writer = RecordingWriter::create(name);
    ASSERT_TRUE(writer.value().copy(file.value(), count).ok());
    ASSERT_TRUE(writer.value().finish().ok());
    EXPECT_EQ(content(), expected) << count;
  }
}

TEST_F(RecordingFileTest, OtherFilesAreExplained) {
  EXPECT_THAT(error_of_open().message, HasSubstr("No such file"));
  folder.write(name, "");
  EXPECT_EQ(error_of_open().code, "other_format");
  folder.write(name, "vat.rec\n and commands");
  EXPECT_THAT(error_of_open().message, HasSubstr("see vat replay"));
  const std::string bytes = write(2);
  folder.write(name, bytes.substr(0, bytes.size() - 1));
  EXPECT_EQ(error_of_open().code, "incomplete");
  EXPECT_EQ(error_of_open().path, name);
}

TEST_F(RecordingFileTest, DamagedDescriptionIsRefused) {
  std::string bytes = write(2);
  bytes[14] = static_cast<char>(bytes[14] ^ 1);
  folder.write(name, bytes);
  Result<RecordingFile> file = RecordingFile::open(name);
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file.value().description(0).errors()[0].code, "damaged");
}

ResumeState make_state() {
  ResumeState state;
  state.order = {"0.1.0", "avx2", "{}", 0.02, 0.001, 0.5, std::nullopt};
  state.step = 120;
  state.frames = 7;
  state.last_header = {1, 2, 3};
  state.snapshot = Bytes(1000, 5);
  return state;
}

TEST_F(RecordingFileTest, StateIsReadUnchanged) {
  const ResumeState state = make_state();
  ASSERT_TRUE(write_resume_state(name, state).ok());
  EXPECT_THAT(folder.names(), ElementsAre("a.vatrec.state"));
  const Result<ResumeState> read = read_resume_state(name);
  ASSERT_TRUE(read.ok()) << read.errors()[0].message;
  EXPECT_EQ(read.value().order, state.order);
  EXPECT_EQ(read.value().step, state.step);
  EXPECT_EQ(read.value().frames, state.frames);
  EXPECT_EQ(read.value().last_header, state.last_header);
  EXPECT_EQ(read.value().snapshot, state.snapshot);
  remove_resume_state(name);
  EXPECT_THAT(folder.names(), ElementsAre());
  EXPECT_EQ(read_resume_state(name).errors()[0].code, "io_error");
}

TEST_F(RecordingFileTest, DamagedOrCutStateIsRefused) {
  ASSERT_TRUE(write_resume_state(name, make_state()).ok());
  const std::string state_name = resume_name(name);
  std::ifstream file(state_name, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    folder.write(state_name, damaged);
    ASSERT_FALSE(read_resume_state(name).ok()) << at;
    folder.write(state_name, bytes.substr(0, at));
    ASSERT_FALSE(read_resume_state(name).ok()) << at;
  }
}

TEST(RecordingOrder, NamesTheOptionThatDiffers) {
  const RecordingOrder order = make_state().order;
  EXPECT_TRUE(check_same(order, order).ok());
  const auto difference = [&order](const std::function<void(RecordingOrder&)>& change) {
    RecordingOrder other = order;
    change(other);
    const Status same = check_same(order, other);
    return same ? std::string() : same.errors()[0].message;
  };
  EXPECT_THAT(difference([](auto& other) { other.program = "0.2"; }), HasSubstr("0.1.0"));
  EXPECT_THAT(difference([](auto& other) { other.scene = "[]"; }), HasSubstr("scene"));
  EXPECT_THAT(difference([](auto& other) { other.instruction_set = "avx512"; }),
              HasSubstr("--isa (avx2)"));
  EXPECT_THAT(difference([](auto& other) { other.frame_seconds = 1; }), HasSubstr("--every"));
  EXPECT_THAT(difference([](auto& other) { other.step = 1; }), HasSubstr("--every"));
  EXPECT_THAT(difference([](auto& other) { other.max_error.reset(); }), HasSubstr("--max-error"));
  EXPECT_THAT(difference([](auto& other) { other.key_every = 9; }), HasSubstr("--key-every"));
}

}  // namespace
}  // namespace vat::test::recording_file_test

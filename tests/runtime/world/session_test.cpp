// A session recorded and replayed: the same state after every step, or the step that differs by its number.
#include "runtime/world/session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/base/random.h"
#include "runtime/view/editor_core.h"
#include "runtime/world/world_drawing.h"
#include "tests/support/scenes/busy_scene.h"

namespace liana {
namespace {

constexpr size_t kSteps = 250;

class Session : public ::testing::Test {
 protected:
  Session() : scene_(test::busy_scene(folder_)) {}

  void leave_only_the_trees() {  // quick
    scene_.wind.air.reset();
    scene_.climbers.clear();
  }

  /// A user who grabs, drags, lets go, cuts, looks around and pauses; what is hit depends on where plants
  /// are.
  WorldReport play(const std::string& name, uint64_t seed = 1) {
    World world(scene_, 2);
    SessionRecorder recorder(world, folder_ / name);
    EditorCore core(recorder, {.width = 640, .height = 360, .camera = camera_of(world)});
    Random random(seed, "tests/session");
    while (world.stats().steps < kSteps) {
      const double what = random.uniform();
      const double x = random.uniform(0, 640), y = random.uniform(0, 360);
      const size_t hit = random.next() % world.plant_count();
      const Plant& plant = world.plant(hit);
      if (what < 0.4 && !plant.motion.empty()) {
        const Vec3 at =
            core.camera().project(plant.motion[random.next() % plant.motion.size()].position, 640, 360);
        core.handle(MoveEvent{at.x(), at.y()});
        if (what < 0.05) core.handle(KeyEvent{Key::Cut});
        if (what > 0.1) core.handle(ButtonEvent{MouseButton::Left, true, at.x(), at.y()});
        grabs_ += what > 0.1 && core.grab().has_value();
      } else if (what < 0.7) {
        core.handle(MoveEvent{x, y});
      } else if (what < 0.8) {
        core.handle(ButtonEvent{MouseButton::Left, false, x, y});
      } else if (what < 0.85) {
        core.handle(KeyEvent{Key::Step});
        core.handle(KeyEvent{Key::Pause});
      }
      core.advance(random.uniform(0, 3) * world.time_step());
    }
    last_state_ = world.state_hash();
    return world.report();
  }

  /// Steps that are as recorded; `what_` says why there are no more.
  size_t replay(const std::string& name, unsigned threads = 1) {
    SessionReplay replay(folder_ / name);
    World world(scene_, threads);
    try {
      while (world.stats().steps < replay.steps()) replay.step(world);
      what_.clear();
      replayed_state_ = world.state_hash();
      return replay.steps();
    } catch (const Error& error) {
      what_ = error.what();
    }
    return world.stats().steps;
  }

  std::vector<std::string> lines(const std::string& name) const {
    std::istringstream in(read_file(folder_ / name));
    std::vector<std::string> all;
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }
  void write(const std::string& name, const std::vector<std::string>& lines) const {
    std::ofstream out(folder_ / name);
    for (const std::string& line : lines) out << line << '\n';
  }

  ScratchFolder folder_;
  Scene scene_;
  size_t grabs_ = 0;
  uint64_t last_state_ = 0, replayed_state_ = 1;
  std::string what_;
};

TEST_F(Session, ReplayedHasTheSameStateAfterEveryStepWithAnyNumberOfThreads) {
  const WorldReport report = play("a.session");
  EXPECT_GT(grabs_, 10u) << "the session is one";
  EXPECT_GT(report.cut, 1u);
  EXPECT_GT(report.broken + report.shed, 1u);
  EXPECT_GT(report.anchors, 0u) << "the climber grew";
  EXPECT_GT(report.air->emitted, 100u);
  for (const unsigned threads : {1u, 2u}) {
    EXPECT_GE(replay("a.session", threads), kSteps) << what_;
    EXPECT_EQ(what_, "");
    EXPECT_EQ(replayed_state_, last_state_);
  }
}

TEST_F(Session, WhatWasTamperedWithIsNamedByStepAndLine) {
  leave_only_the_trees();
  play("a.session");
  const std::vector<std::string> whole = lines("a.session");
  size_t grab = whole.size() / 2;
  while (whole[grab].rfind("{\"grab\"", 0) != 0 || whole[grab + 1].rfind("{\"step\"", 0) != 0) ++grab;
  const size_t step = std::stoul(whole[grab + 1].substr(8));

  std::vector<std::string> other = whole;
  size_t digit = other[grab].find('.', other[grab].find("\"target\":[")) + 1;  // after the decimal point
  other[grab][digit] = other[grab][digit] == '1' ? '2' : '1';
  write("act.session", other);
  EXPECT_EQ(replay("act.session"), step) << "the world took the step that then differed";
  EXPECT_NE(what_.find("step " + std::to_string(step) + " is the first that differs"), std::string::npos)
      << what_;
  EXPECT_NE(what_.find("act.session:" + std::to_string(grab + 2) + ":"), std::string::npos) << what_;

  other = whole;
  other.erase(other.begin() + static_cast<std::ptrdiff_t>(grab) + 1);
  write("gap.session", other);
  EXPECT_THROW(SessionReplay(folder_ / "gap.session"), Error);

  scene_.plants[1].yaw += 1e-9;
  EXPECT_EQ(replay("a.session"), 0u);
  EXPECT_NE(what_.find("starts in state"), std::string::npos) << what_;
}

TEST_F(Session, WhatACrashCutShortIsReplayedToItsLastWholeLine) {
  leave_only_the_trees();
  play("a.session");
  const std::string whole = read_file(folder_ / "a.session");
  write_file(folder_ / "cut.session", whole.substr(0, whole.size() * 2 / 3));
  const size_t steps = replay("cut.session", 2);
  EXPECT_EQ(what_, "");
  EXPECT_GT(steps, kSteps / 3);
  EXPECT_LT(steps, kSteps);
}

TEST_F(Session, NonsenseIsAnErrorOfTheInput) {
  leave_only_the_trees();
  play("a.session");
  const std::vector<std::string> whole = lines("a.session");
  Random random(7, "tests/session/nonsense");
  for (int i = 0; i < 30; ++i) {
    std::vector<std::string> other(whole.begin(), whole.begin() + 40);
    std::string& line = other[random.next() % other.size()];
    switch (random.next() % 3) {
      case 0:
        line[random.next() % line.size()] = static_cast<char>(random.next() % 256);
        break;
      case 1:
        line.erase(random.next() % line.size(), 1 + random.next() % 20);
        break;
      default:
        line = random.next() % 2 == 0 ? R"({"cut":{"plant":0,"particle":4000000000}})"
                                      : R"({"cut":{"plant":18446744073709551615,"particle":0}})";
    }
    write("b.session", other);
    try {
      replay("b.session");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind, Error::Kind::Input) << error.what();
    }
  }
  EXPECT_THROW(SessionReplay(folder_ / "none.session"), Error);
}

}  // namespace
}  // namespace liana

// After warm-up a step allocates nothing and starts no thread.
#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "mesher/base/parallel.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/contact/contact_step.h"
#include "runtime/sim/contact/plant_contacts.h"
#include "tests/support/allocation_count.h"
#include "tests/support/plants/synthetic_bake.h"

namespace liana {
namespace {

/// Two large trees in gusts, each pressed by a box that moves to and fro and by one that stands, and by the
/// other.
class Grove {
 public:
  explicit Grove(unsigned threads)
      : threads_(threads),
        standing_(box_mesh({-0.6, 1.1, 0.03}, {0.6, 1.3, 0.2})),
        moving_(box_mesh({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1})) {
    for (int i = 0; i < 2; ++i) {
      PlacementOptions placement;
      placement.position = {0.3 * i, 0, 0};
      plants_.push_back(make_plant(test::synthetic_bake({.branches = 24}), placement));
      wrenches_.emplace_back(plants_[i].particles.size());
    }
    for (size_t i = 0; i < 2; ++i) all_.push_back(&plants_[i]), lists_.push_back(&springs_[i]);
  }

  size_t particles() const { return plants_[0].particles.size(); }

  ContactReport step() {
    const double t = 0.025 * ++steps_;
    ObstaclePose pose;
    pose.position = pose.centre = {0.15 + 0.1 * std::sin(4 * t), 1.5, 0.1 * std::cos(4 * t)};
    pose.velocity = {0.4 * std::cos(4 * t), 0, -0.4 * std::sin(4 * t)};
    moving_.place(pose);
    const SdfObstacle* solids[] = {&moving_, &standing_};
    for (auto& list : springs_) list.clear();
    touches_ += touching_.gather(all_, lists_).contacts;
    ContactReport total;
    for (size_t k = 0; k < 2; ++k) {
      const Plant& plant = plants_[k];
      for (uint32_t i = 0; i < plant.particles.size(); ++i) {
        WorldSpring drag;
        drag.particle = ParticleId(i);
        drag.damping = 0.2 * plant.particles[i].mass * Mat3::Identity();
        drag.target_velocity = {6 * std::sin(3 * t), 0, 3 * std::cos(5 * t)};
        springs_[k].push_back(drag);
        wrenches_[k][i].force = Vec3(0, 0, 0.3 * plant.particles[i].mass * std::sin(2 * t));
      }
      const ContactStepReport report = steppers_[k].step(plants_[k], {solids, 0.0}, wrenches_[k], springs_[k],
                                                         {.threads = threads_}, workspace_);
      total.contacts += report.contacts.contacts;
      EXPECT_TRUE(report.step.finite);
    }
    return total;
  }
  size_t touches() const { return touches_; }

 private:
  unsigned threads_;
  SdfObstacle standing_, moving_;
  std::vector<Plant> plants_;
  std::vector<std::vector<Wrench>> wrenches_;
  std::vector<WorldSpring> springs_[2];
  std::vector<const Plant*> all_;
  std::vector<std::vector<WorldSpring>*> lists_;
  PlantContacts touching_;
  ContactStepper steppers_[2];
  StepWorkspace workspace_;
  size_t touches_ = 0;
  int steps_ = 0;
};

bool counts() {
  const size_t before = test::allocation_count(), threads = test::thread_count();
  const auto number = std::make_unique<volatile int>(1);
  std::thread([] {}).join();
  return test::allocation_count() > before && test::thread_count() == threads + 1;
}

TEST(Allocation, AStepInContactAndWindAllocatesNothingAndStartsNoThread) {
  if (!counts()) GTEST_SKIP() << "this build's memory functions are not ours";
  for (const unsigned threads : {1u, 2u}) {
    Grove grove(threads);
    ASSERT_GT(grove.particles(), 400u) << "threads share it";
    for (int i = 0; i < 80; ++i) grove.step();  // half a swing of the box
    const size_t allocations = test::allocation_count(), started = test::thread_count();
    size_t contacts = 0;
    const size_t touched = grove.touches();
    for (int i = 0; i < 100; ++i) contacts += grove.step().contacts;
    EXPECT_EQ(test::allocation_count() - allocations, 0u) << threads << " threads";
    EXPECT_EQ(test::thread_count() - started, 0u) << threads << " threads";
    EXPECT_GT(contacts, 500u);
    EXPECT_GT(grove.touches() - touched, 100u);
  }
}

TEST(Allocation, LoopsInsideLoopsStartNoThreadAndDoEverythingOnce) {
  start_threads(4);
  const size_t started = test::thread_count();
  for (int turn = 0; turn < 50; ++turn) {
    std::vector<std::vector<int>> done(7, std::vector<int>(90, 0));
    parallel_for(done.size(), 4, [&](size_t i, unsigned) {
      parallel_for(
          done[i].size(), 4, [&](size_t j, unsigned worker) { done[i][j] += worker < 4 ? 1 : 100; }, 3);
    });
    for (const auto& row : done)
      for (const int times : row) ASSERT_EQ(times, 1);
  }
  EXPECT_EQ(test::thread_count() - started, 0u);
}

TEST(Allocation, TheFirstFailureOfALoopComesOutOfItWhoeverMetIt) {
  for (int turn = 0; turn < 20; ++turn) {
    try {
      parallel_for(100, 4, [&](size_t i, unsigned) {
        if (i == 17) throw static_cast<int>(i);
      });
      FAIL();
    } catch (int which) {
      EXPECT_EQ(which, 17);
    }
  }
}

}  // namespace
}  // namespace liana

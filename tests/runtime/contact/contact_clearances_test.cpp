#include <gtest/gtest.h>

#include "mesher/base/random.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/contact/contact_step.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/sim/model/topology.h"
#include "runtime/wind/field/sheltered_wind.h"
#include "runtime/wind/field/steady_gust_wind.h"
#include "tests/support/plants/synthetic_bake.h"
#include "tests/support/scenes/climber_scene.h"

namespace liana {
namespace {

const ContactOptions kLooksAtAll = [] {
  ContactOptions options;
  options.remember_clearances = false;
  return options;
}();

/// A plate of four corners over a fifth one: edges, an oblique face, no symmetry.
Mesh wedge() {
  Mesh mesh = box_mesh({-0.4, 0, -0.1}, {0.5, 0.9, 0.1});
  for (Vec3& p : mesh.positions) p.z() += 0.3 * p.y() * p.x();
  return mesh;
}

TEST(Clearances, NoPointOfABoxIsNearerThanItsLeastDistance) {
  for (const Mesh& mesh : {wedge(), box_mesh({-0.4, 0, -0.1}, {0.5, 0.9, 0.1})}) {
    SdfObstacle solid(mesh, {.voxel = 0.03, .band = 0.09});
    Random random(11, "boxes");
    size_t informative = 0;
    for (int i = 0; i < 3000; ++i) {
      if (i == 1500)
        solid.place(
            {.rotation = Quat(Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized())), .position = {0.1, 0, 0}});
      const auto anywhere = [&](double low, double high) {
        const double x = random.uniform(low, high), y = random.uniform(low, high),
                     z = random.uniform(low, high);
        return Vec3(x, y, z);
      };
      const Vec3 centre = anywhere(-0.7, 1.1), half = anywhere(0, 0.06);
      const double least = solid.least(centre, half);
      if (!(least > 0)) continue;
      informative += least > 0.005;
      for (int k = 0; k < 30; ++k)
        ASSERT_GE(solid.distance(centre + half.cwiseProduct(anywhere(-1, 1))), least - 1e-12) << i;
    }
    EXPECT_GT(informative, 1000u);
  }
}

TEST(Clearances, AGrowingPlantInWindMovesAsIfAllOfItWereLookedAt) {
  ClimberParameters parameters;
  parameters.first_shoots = 3;
  parameters.max_particles = 500;
  const uint64_t seed =
      3;  // of the first five the one that touches the wall most: 409 springs, others 50 to 386
  ClimberScene one(parameters, seed), all(parameters, seed);
  all.stepper = ContactStepper(kLooksAtAll);
  GustParameters gusts;
  gusts.mean = {4, 0, -8};  // leaves are blown against the wall
  const SteadyGustWind open(gusts);
  const ShelteredWind wind(open, {&one.wall}, 0.0);
  for (int i = 0; i < 800; ++i) {
    one.step(&wind), all.step(&wind);
    ASSERT_EQ(state_hash(one.plant), state_hash(all.plant)) << "step " << i;
  }
  EXPECT_EQ(one.contact_springs, all.contact_springs);
  EXPECT_GT(one.contact_springs, 100u);
  EXPECT_EQ(one.max_penetration, all.max_penetration);
}

TEST(Clearances, AShakenTreeAmongMovingSolidsMovesAsIfAllOfItWereLookedAt) {
  SdfObstacle post(box_mesh({-0.05, 0, -0.05}, {0.05, 2.5, 0.05})),
      cube(box_mesh({0, 0, 0}, {0.3, 0.3, 0.3}));
  post.place({.position = {0.25, 0, 0.1}});
  const std::vector<const SdfObstacle*> solids{&post, &cube};
  Plant plant[2] = {make_plant(test::synthetic_bake({.branches = 4})),
                    make_plant(test::synthetic_bake({.branches = 4}))};
  ContactStepper stepper[2] = {ContactStepper(), ContactStepper(kLooksAtAll)};
  Random random(3, "gusts");
  size_t contacts = 0;
  for (int i = 0; i < 400; ++i) {
    // It comes, waits, is put elsewhere and comes again; the ground rises.
    const bool moves = i % 100 < 60;
    const double way = 0.02 * std::min(i % 100, 60);
    cube.place({.position = Vec3(-1.2 + way, 0.8 + 0.1 * (i / 100), -0.15),
                .velocity = moves ? Vec3(0.8, 0, 0) : Vec3::Zero().eval()});
    const CollisionScene scene{solids, i < 250 ? 0.0 : 0.1};
    const Vec3 push(random.uniform(-1, 1), 0, random.uniform(-1, 1));
    if (i == 300)
      for (int k : {0, 1}) {
        const std::vector<ParticleId>& trunk = plant[k].branches[0].particles;
        remove_subtree(plant[k], trunk[trunk.size() * 2 / 3]);
      }
    ContactStepReport report[2];
    for (int k : {0, 1}) {
      const std::vector<Wrench> wind(plant[k].particles.size(), {.force = 2e-2 * push});
      std::vector<WorldSpring> springs;
      report[k] = stepper[k].step(plant[k], scene, wind, springs, {});
    }
    contacts += report[0].contacts.contacts;
    ASSERT_EQ(report[0].contacts.contacts, report[1].contacts.contacts) << "step " << i;
    ASSERT_EQ(report[0].contacts.max_penetration, report[1].contacts.max_penetration) << "step " << i;
    ASSERT_EQ(state_hash(plant[0]), state_hash(plant[1])) << "step " << i;
  }
  EXPECT_GT(contacts, 500u);
}

}  // namespace
}  // namespace liana

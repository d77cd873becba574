// Materials from video, end to end: a plant of known material is filmed by our own renderer, and what the
// video tells of it is compared with what it was given.
#include "tests/support/plants/filmed_plant.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "materials/bake/bake_file.h"
#include "materials/law/species_file.h"
#include "mesher/base/files.h"
#include "runtime/app/scene/scene_preparation.h"
#include "runtime/view/video.h"
#include "runtime/world/world_drawing.h"
#include "tests/support/program.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

constexpr int kWidth = 480, kHeight = 360;

class InferFromVideo : public testing::Test {
 protected:
  void run(const std::vector<std::string>& arguments) {
    const ProgramResult result = run_liana(arguments, folder_.path());
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  }

  /// Films the plant; returns --point options for the branches' tips, by name.
  std::vector<std::string> film(const std::string& scene, double seconds) {
    write_bake(test::filmed_plant(), folder_ / "plant.bake");
    write_file(folder_ / "scene.toml", scene);
    const std::string length = std::to_string(seconds);
    run({"simulate", "scene.toml", "--seconds", length, "--mp4", "plant.mp4", "--video-seconds", length,
         "--true-pace", length, "--smooth-video", "--video-size", std::to_string(kWidth),
         std::to_string(kHeight)});
    const World world(load_scene(folder_ / "scene.toml"));
    std::vector<std::string> points;
    for (const Branch& branch : world.plant(0).branches) {
      const size_t tip = branch.particles.back().index();
      const Motion& m = world.plant(0).motion[tip];
      const Vec3 end = m.position + m.orientation * Vec3(0, world.plant(0).particles[tip].half_length, 0);
      const Vec3 pixel = camera_of(world).project(end, kWidth, kHeight);
      points.push_back("--point");
      points.push_back(std::to_string(pixel.x()) + "," + std::to_string(pixel.y()) + "=#" +
                       std::to_string(branch.domain.index()));
    }
    return points;
  }

  /// The law that was written says of every branch what it was baked with.
  void expect_known_material(double frequency_tolerance, double damping_tolerance) {
    const SpeciesLaw law = read_species(folder_ / "inferred.toml");
    for (const BakedDomain& domain : test::filmed_plant().domains) {
      const DomainMaterial inferred = evaluate(law.group(domain.group), domain.length);
      EXPECT_NEAR(inferred.frequency / domain.material.frequency, 1, frequency_tolerance) << domain.name;
      EXPECT_NEAR(inferred.damping_factor / domain.material.damping_factor, 1, damping_tolerance)
          << domain.name;
    }
  }

  ScratchFolder folder_;
};

TEST_F(InferFromVideo, PlantLetGoGivesBackItsMaterial) {
  std::vector<std::string> command = {"infer",     "plant.mp4",     "--plant",    "plant.bake",
                                      "--species", "apple",         "-o",         "inferred.toml",
                                      "--json",    "inferred.json", "--spectrum", "spectrum.csv",
                                      "--overlay", "overlay.mp4",   "--tracks",   "tracks.csv"};
  for (const std::string& option : film(test::kFilmedScene + test::kImpulses, 10)) command.push_back(option);
  run(command);
  expect_known_material(0.03, 0.20);
  const auto json = nlohmann::json::parse(read_file(folder_ / "inferred.json"));
  EXPECT_EQ(json["groups"].size(), 2u);
  EXPECT_EQ(json["points"].size(), 4u);
  EXPECT_NE(read_file(folder_ / "spectrum.csv").find("\nP3,"), std::string::npos);
  EXPECT_EQ(read_file(folder_ / "overlay.mp4").substr(4, 4), "ftyp");
  // The tracks alone say the same.
  run({"infer", "tracks.csv", "--fps", "25", "--plant", "plant.bake", "--species", "apple", "-o",
       "inferred.toml", "--assign", "P0=#0", "--assign", "P1=#1", "--assign", "P2=#2", "--assign", "P3=#3"});
  expect_known_material(0.03, 0.20);
}

/// What the program says when it refuses.
std::string refusal(const ScratchFolder& folder, std::vector<std::string> arguments, int code = 1) {
  arguments.insert(arguments.begin(), "infer");
  const ProgramResult result = run_liana(arguments, folder.path());
  EXPECT_EQ(result.exit_code, code) << result.out << result.err;
  EXPECT_EQ(result.err.find("fault of its own"), std::string::npos) << result.err;
  return result.err;
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(InferProgram, RefusesWhatIsNoVideoOrMovesNot) {
  const ScratchFolder folder;
  write_file(folder / "text.mp4", "no video at all\n");
  EXPECT_TRUE(says(refusal(folder, {"text.mp4"}), "text.mp4: is no video"));
  EXPECT_TRUE(says(refusal(folder, {"none.mp4"}), "none.mp4: no such file"));
  {
    VideoWriter writer(folder / "still.mp4", 64, 48, 25);
    Image image{64, 48, std::vector<uint8_t>(64 * 48 * 3, 90)};
    for (size_t i = 0; i < image.pixels.size(); i += 7) image.pixels[i] = 200;
    for (int i = 0; i < 60; ++i) writer.add(image);
    writer.finish();
  }
  EXPECT_TRUE(says(refusal(folder, {"still.mp4"}), "still.mp4: nothing moves in 60 frames"));
  EXPECT_TRUE(says(refusal(folder, {"still.mp4", "--point", "20,20=level1:1"}), "does not move"));
  EXPECT_TRUE(says(refusal(folder, {"still.mp4", "--point", "200,20=level1:1"}, 2),
                   "outside the picture of 64 x 48"));
  const std::string whole = read_file(folder / "still.mp4");
  write_file(folder / "cut.mp4", whole.substr(0, whole.size() / 3));
  refusal(folder, {"cut.mp4"});
}

TEST(InferProgram, RefusesTracksThatMakeNoSense) {
  const ScratchFolder folder;
  write_file(folder / "t.csv", "frame,point,x,y\n0,P,1,2\n0,P,1,2\n");
  EXPECT_TRUE(says(refusal(folder, {"t.csv", "--fps", "30"}), "t.csv:3: frame 0"));
  EXPECT_TRUE(says(refusal(folder, {"t.csv"}, 2), "--fps 30"));
  EXPECT_TRUE(says(refusal(folder, {"t.csv", "--fps", "30", "--point", "1,2"}, 2), "--assign"));
  EXPECT_TRUE(says(refusal(folder, {"t.csv", "--fps", "30", "--wind", "west"}, 2), "--wind west"));
  EXPECT_TRUE(says(refusal(folder, {"t.csv", "--fps", "30", "--between", "3", "1"}, 2), "--between"));
  EXPECT_TRUE(says(refusal(folder, {"t.csv", "--fps", "30", "-o", "no/where.toml"}), "no such folder"));
  EXPECT_TRUE(says(refusal(folder, {"t.csv", "--fps", "30", "-o", "mine.toml"}, 2), "no point is assigned"));
  EXPECT_FALSE(std::filesystem::exists(folder / "mine.toml"));
}

TEST(SceneImpulses, UnknownBranchOrPlantIsRefused) {
  const ScratchFolder folder;
  write_bake(test::filmed_plant(), folder / "plant.bake");
  const auto said = [&](const std::string& impulse) {
    write_file(folder / "scene.toml", test::kFilmedScene + "[[pluck]]\n" + impulse);
    return run_liana({"simulate", "scene.toml", "--seconds", "0"}, folder.path()).err;
  };
  EXPECT_TRUE(says(said("domain = \"lefft\"\nvelocity = [1, 0, 0]\n"), "did you mean 'left'"));
  EXPECT_TRUE(says(said("plant = 1\ndomain = \"left\"\nvelocity = [1, 0, 0]\n"), "plant"));
  EXPECT_TRUE(says(said("domain = \"left\"\nvelocity = [200, 0, 0]\n"), "100 m/s"));
}

}  // namespace
}  // namespace liana

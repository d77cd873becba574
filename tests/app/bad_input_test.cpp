// Whatever a user feeds the program: one clear message, the right exit code, no crash, nothing half-written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "mesher/base/files.h"
#include "mesher/io/plant_file.h"
#include "tests/support/program.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kData = LIANA_SOURCE_DIR "/data";
const std::string kSmallTree = kData / "plants/apple_small.glb";

class BadInput : public testing::Test {
 protected:
  /// One line that says what, perhaps one that says what to try; nothing new in the folder.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& said, int code = 1) {
    const size_t before = files();
    const ProgramResult result = run_liana(arguments, folder_.path());
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, HasSubstr("liana: "));
    EXPECT_THAT(result.err, HasSubstr(said));
    EXPECT_LE(std::count(result.err.begin(), result.err.end(), '\n'), 4) << result.err;
    EXPECT_THAT(result.err, Not(HasSubstr("fault of its own"))) << result.err;
    EXPECT_EQ(files(), before) << "something was left behind";
  }

  std::string write(const std::string& name, const std::string& bytes) {
    write_file(folder_ / name, bytes);
    return name;
  }

  std::string small_bake() {
    const ProgramResult result =
        run_liana({"bake", kSmallTree, "--species", "apple", "-o", "small.bake"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_file(folder_ / "small.bake");
  }

  size_t files() const {
    return static_cast<size_t>(std::distance(fs::recursive_directory_iterator(folder_.path()), {}));
  }

  ScratchFolder folder_;
};

std::string random_bytes(size_t count) {
  std::mt19937 random(17);
  std::string bytes(count, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  return bytes;
}

/// A glTF text file with one triangle strip's worth of positions per node.
nlohmann::json gltf_with(const std::vector<float>& positions, const nlohmann::json& nodes) {
  static const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const auto* bytes = reinterpret_cast<const unsigned char*>(positions.data());
  const size_t size = positions.size() * sizeof(float);
  std::string base64;
  for (size_t i = 0; i < size; i += 3) {
    const uint32_t word = uint32_t{bytes[i]} << 16 | (i + 1 < size ? uint32_t{bytes[i + 1]} << 8 : 0) |
                          (i + 2 < size ? uint32_t{bytes[i + 2]} : 0);
    for (int digit = 0; digit < 4; ++digit)
      base64 += i + static_cast<size_t>(digit) <= size ? kDigits[word >> (18 - 6 * digit) & 63] : '=';
  }
  nlohmann::json roots = nlohmann::json::array();
  for (size_t i = 0; i < nodes.size(); ++i) roots.push_back(i);
  return {{"asset", {{"version", "2.0"}}},
          {"scene", 0},
          {"scenes", {{{"nodes", roots}}}},
          {"nodes", nodes},
          {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
          {"accessors",
           {{{"bufferView", 0}, {"componentType", 5126}, {"count", positions.size() / 3}, {"type", "VEC3"}}}},
          {"bufferViews", {{{"buffer", 0}, {"byteLength", size}}}},
          {"buffers", {{{"byteLength", size}, {"uri", "data:application/octet-stream;base64," + base64}}}}};
}

const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

TEST_F(BadInput, MissingFileIsNamed) {
  expect_refused({"bake", "absent.glb", "--species", "apple", "-o", "x.bake"}, "absent.glb");
  expect_refused({"inspect", "absent.glb"}, "absent.glb");
  expect_refused({"verify", "absent.bake"}, "absent.bake");
  expect_refused({"simulate", "absent.toml"}, "absent.toml");
}

TEST_F(BadInput, RandomBytesAreNoPlantNoSceneNoBake) {
  for (const char* name : {"noise.glb", "noise.gltf", "noise.toml", "noise.bake"})
    write(name, random_bytes(4096));
  for (const char* name : {"noise.glb", "noise.gltf"})
    expect_refused({"bake", name, "--species", "apple", "-o", "x.bake"}, name);
  expect_refused({"bake", kSmallTree, "--species", "./noise.toml", "-o", "x.bake"}, "noise.toml");
  expect_refused({"verify", "noise.bake"}, "noise.bake");
  expect_refused({"simulate", "noise.toml"}, "noise.toml");
  for (const char* name : {"noise.glb", "noise.gltf", "noise.toml", "noise.bake"})
    expect_refused({"inspect", name}, name);
}

TEST_F(BadInput, TruncatedPlantIsRefused) {
  const std::string whole = read_file(kSmallTree);
  for (const size_t size :
       {size_t{0}, size_t{7}, size_t{12}, size_t{21}, whole.size() / 2, whole.size() - 1}) {
    write("cut.glb", whole.substr(0, size));
    expect_refused({"bake", "cut.glb", "--species", "apple", "-o", "x.bake"}, "cut.glb");
  }
}

TEST_F(BadInput, DamagedBakeIsRefused) {
  const std::string whole = small_bake();
  write("cut.bake", whole.substr(0, whole.size() / 2));
  expect_refused({"verify", "cut.bake"}, "cut.bake");
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 4;
  write("flipped.bake", flipped);
  expect_refused({"verify", "flipped.bake"}, "flipped.bake");
  std::string newer = whole;
  newer[8] ^= 0x40;  // the version follows the 8 bytes of the magic
  write("newer.bake", newer);
  expect_refused({"verify", "newer.bake"}, "version");
}

TEST_F(BadInput, CyclicNodesAreRefused) {
  auto gltf = gltf_with(kTriangle, {{{"name", "a"}, {"mesh", 0}, {"children", {1}}},
                                    {{"name", "b"}, {"mesh", 0}, {"children", {0}}}});
  write("cycle.gltf", gltf.dump());
  expect_refused({"bake", "cycle.gltf", "--species", "apple", "-o", "x.bake"}, "cycle.gltf");
}

TEST_F(BadInput, PlantOutsideItsSceneIsRefused) {
  auto gltf = gltf_with(kTriangle, {{{"name", "a"}, {"mesh", 0}, {"children", {7}}}});
  write("orphan.gltf", gltf.dump());
  expect_refused({"bake", "orphan.gltf", "--species", "apple", "-o", "x.bake"}, "orphan.gltf");
}

TEST_F(BadInput, MeshWithoutTrianglesOrWithNotANumberOrWithoutAreaIsRefused) {
  const auto node = nlohmann::json::array({{{"name", "trunk"}, {"mesh", 0}}});
  auto empty = gltf_with(kTriangle, node);
  empty["accessors"][0]["count"] = 0;
  write("empty.gltf", empty.dump());
  expect_refused({"bake", "empty.gltf", "--species", "apple", "-o", "x.bake"}, "empty.gltf");
  auto nan = kTriangle;
  nan[4] = std::numeric_limits<float>::quiet_NaN();
  write("nan.gltf", gltf_with(nan, node).dump());
  expect_refused({"bake", "nan.gltf", "--species", "apple", "-o", "x.bake"}, "trunk");
  write("flat.gltf", gltf_with({0, 0, 0, 1, 0, 0, 2, 0, 0}, node).dump());
  expect_refused({"bake", "flat.gltf", "--species", "apple", "-o", "x.bake"}, "flat.gltf");
}

/// A Möbius band 4 cm wide: neither an open tube nor a body nor a sheet with two sides.
Mesh moebius_band() {
  Mesh band;
  const uint32_t n = 24;
  for (uint32_t i = 0; i < n; ++i) {
    const double turn = 2 * kPi * i / n;
    for (const double across : {-0.02, 0.02}) {
      const double radius = 0.1 + across * std::cos(turn / 2);
      band.positions.push_back(
          {radius * std::cos(turn), 1 + across * std::sin(turn / 2), radius * std::sin(turn)});
    }
  }
  for (uint32_t i = 0; i < n; ++i) {
    const bool closing = i == n - 1;
    const uint32_t a = 2 * i, b = a + 1, c = closing ? 1 : a + 2, d = closing ? 0 : a + 3;
    band.triangles.push_back({a, c, b});
    band.triangles.push_back({b, c, d});
  }
  return band;
}

TEST_F(BadInput, DomainThatCannotBeSolidIsNamedAndTheOthersAreBaked) {
  SegmentedPlant plant = read_plant(kSmallTree);
  const size_t sound = plant.domains.size();
  plant.domains.push_back(
      {.name = "moebius", .parent = DomainId(0), .level = 1, .group = "level1", .surface = moebius_band()});
  write_plant(plant, folder_ / "odd.glb");

  expect_refused({"bake", "odd.glb", "--species", "apple", "-o", "x.bake", "--strict"}, "moebius");

  const ProgramResult partial = run_liana(
      {"bake", "odd.glb", "--species", "apple", "-o", "x.bake", "--report", "x.json"}, folder_.path());
  EXPECT_EQ(partial.exit_code, 3);
  EXPECT_THAT(partial.out + partial.err, HasSubstr("moebius"));
  EXPECT_EQ(nlohmann::json::parse(read_file(folder_ / "x.json"))["domains"].size(), sound);
  EXPECT_EQ(run_liana({"inspect", "x.bake"}, folder_.path()).exit_code, 0);
}

TEST_F(BadInput, UnknownSpeciesSuggestsTheNearest) {
  expect_refused({"bake", kSmallTree, "--species", "aple", "-o", "x.bake"}, "apple");
}

TEST_F(BadInput, SceneThatNamesAMissingFileSaysWhereAndWhich) {
  write("scene.toml", "[[plant]]\nbake = \"absent.bake\"\n");
  expect_refused({"simulate", "scene.toml"}, "scene.toml:2");
  expect_refused({"simulate", "scene.toml"}, "absent.bake");
}

TEST_F(BadInput, WindOfASceneIsRefusedWithItsLine) {
  const std::string climber = "[[climber]]\nspecies = \"ivy\"\nposition = [0, 0, 0]\n";  // lines 1 to 3
  const std::string emitter =
      "[wind]\n[[wind.emitter]]\ncenter = [-1, 1, 0]\ndirection = [1, 0, 0]\nspeed = 5\nradius = 0.5\n";
  const struct {
    std::string text;
    int line;
    const char* said;
  } cases[] = {
      {"[wind]\nvelocity = [300, 0, 0]\n", 5, "'velocity' is above 100 m/s"},
      {"[wind]\nvelocity = [1, 0, 0]\nkind = \"storm\"\n", 6, "'kind' must be"},
      {"[wind]\nvelocity = [0, 0, 0]\nkind = \"ambient\"\n", 5, "must not be zero"},
      {"[wind]\nvelocity = [1, 0, 0]\ngusst = 0.2\n", 6, "did you mean 'gust'"},
      {"[wind]\nvelocity = [1, 0, 0]\n[wind.air]\nspacing = 0.1\n", 6, "needs an emitter"},
      {emitter + "colour = 1\n", 10, "'colour' is not known"},
      {"[wind]\n[[wind.emitter]]\ncenter = [0, 1, 0]\ndirection = [0, 0, 0]\nspeed = 5\n", 7, "'direction'"},
      {"[wind]\n[[wind.emitter]]\ncenter = [0, 1, 0]\ndirection = [1, 0, 0]\nspeed = 500\n", 8, "'speed'"},
      {emitter + "[wind.air]\nspacing = 0\n", 11, "'spacing' is 0"},
      {emitter + "[wind.air]\nlow = [5, 5, 5]\nhigh = [9, 9, 9]\n", 6, "outside of the air's domain"},
      {"[[pluck]]\ndomain = \"trunk\"\nvelocity = [1, 0, 0]\n", 4, "no [[plant]] to strike"}};
  for (const auto& [text, line, said] : cases) {
    SCOPED_TRACE(text);
    write("scene.toml", climber + text);
    expect_refused({"simulate", "scene.toml"}, said);
    expect_refused({"simulate", "scene.toml"}, "scene.toml:" + std::to_string(line) + ":");
  }
}

TEST_F(BadInput, ImpulseIsRefusedWithItsLineOrTheNameItMeans) {
  small_bake();
  const std::string plant = "[[plant]]\nbake = \"small.bake\"\n[[pluck]]\n";
  write("fast.toml", plant + "domain = \"trunk\"\nvelocity = [101, 0, 0]\n");
  expect_refused({"simulate", "fast.toml"}, "fast.toml:5: 'velocity' is above 100 m/s");
  write("far.toml", plant + "plant = 1\ndomain = \"trunk\"\nvelocity = [1, 0, 0]\n");
  expect_refused({"simulate", "far.toml"}, "far.toml:4: 'plant'");
  write("late.toml", plant + "time = -1\ndomain = \"trunk\"\nvelocity = [1, 0, 0]\n");
  expect_refused({"simulate", "late.toml"}, "late.toml:4: 'time'");
  write("none.toml", plant + "domain = \"trnk\"\nvelocity = [1, 0, 0]\n");
  expect_refused({"simulate", "none.toml"}, "did you mean 'trunk'");
}

TEST_F(BadInput, ObstaclesThatCannotMoveLikeThatAreRefusedWithTheirLine) {
  const std::string scene =
      "[[climber]]\nspecies = \"ivy\"\nposition = [0, 0, 0]\n[[obstacle]]\n"
      "box = { center = [0, 1, 0], size = [1, 1, 1] }\n";
  write("friction.toml", scene + "friction = 1.5\n");
  expect_refused({"simulate", "friction.toml"}, "friction.toml:6");
  write("keys.toml", scene +
                         "[obstacle.motion]\n[[obstacle.motion.keyframe]]\ntime = 2\n"
                         "[[obstacle.motion.keyframe]]\ntime = 1\n");
  expect_refused({"simulate", "keys.toml"}, "keys.toml:10");
  write("fast.toml", scene + "motion = { velocity = [0, 900, 0] }\n");
  expect_refused({"simulate", "fast.toml"}, "velocity");
}

TEST_F(BadInput, AbsurdNumbersAreRefused) {
  const std::string apple = read_file(kData / "species/apple.toml");
  expect_refused(
      {"bake", kSmallTree, "--species", "apple", "--set", "default_material.density=-3", "-o", "x.bake"},
      "density");
  expect_refused(
      {"bake", kSmallTree, "--species", "apple", "--set", "level0.damping.delta=9", "-o", "x.bake"}, "delta");
  const std::string climber = "[[climber]]\nspecies = \"ivy\"\nposition = [0, 0, 0]\n";
  write("many.toml", climber + "max_particles = 1e9\n");
  expect_refused({"simulate", "many.toml"}, "max_particles");
  write("step.toml", "time_step = -1\n" + climber);
  expect_refused({"simulate", "step.toml"}, "time_step");
  write("typo.toml", "gravty = [0, -9.81, 0]\n" + climber);
  expect_refused({"simulate", "typo.toml"}, "gravity");
}

TEST_F(BadInput, OutputThatCannotBeWrittenIsRefusedBeforeTheWork) {
  expect_refused({"bake", kSmallTree, "--species", "apple", "-o", "no/such/folder/x.bake"}, "no/such/folder");
}

TEST_F(BadInput, WrongCommandLinesTeach) {
  expect_refused({"bkae"}, "bake", 2);
  expect_refused({}, "--help", 2);
  expect_refused({"bake", kSmallTree}, "species", 2);
}

}  // namespace
}  // namespace liana

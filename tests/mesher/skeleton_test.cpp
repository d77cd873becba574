// MTG files and plant graphs become branches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "mesher/base/error.h"
#include "mesher/exact/self_intersection.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/io/graph_file.h"
#include "mesher/io/mtg_file.h"
#include "mesher/shells/load_plant.h"
#include "mesher/solids/skins/branch_tubes.h"
#include "mesher/solids/solidify/solid_domain.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

const std::string kHead =
    "CODE:\tFORM-A\n\nCLASSES:\nSYMBOL\tSCALE\tDECOMPOSITION\tINDEXATION\tDEFINITION\n$"
    "\t0\tFREE\tFREE\tIMPLICIT\n"
    "P \t1\tFREE\tFREE\tEXPLICIT\nA \t2\tFREE\tFREE\tEXPLICIT\nS "
    "\t3\tFREE\tFREE\tEXPLICIT\nU\t3\tFREE\tFREE\tEXPLICIT\n"
    "\nDESCRIPTION :\nLEFT\tRIGHT\tRELTYPE\tMAX\nA\tA\t+\t?\n\nFEATURES:\nNAME\tTYPE\nXX\tREAL\n\nMTG :\n";

// A trunk of four segments with a branch on the second (digitised at its foot) and a twig on that branch.
const std::string kTree = kHead +
                          "ENTITY-CODE\t\t\t\tDist\tXX\tYY\tZZ\tTopDia\n"
                          "/P1\t\t\t\n"
                          "\t/A1\t\t\t9\t0\t0\t0\t100\n"
                          "\t^/S1\t\t\t9\t0\t0\t50\t90\n"
                          "\t^<S2\t\t\t9\t0\t0\t100\t80\n"
                          "\t\t+A1\t\t9\t4\t0\t101\t20\n"
                          "\t\t^/S1\t\t9\t30\t0\t120\t18\n"
                          "\t\t\t+A1\t9\t30\t1\t121\t6\n"
                          "\t\t\t^/U1\t9\t30\t15\t130\t4\n"
                          "\t\t^<S2\t\t9\t60\t0\t130\t12\n"
                          "\t^<S3\t\t\t9\t0\t0\t150\t70\n"
                          "\t^<S4\t\t\t9\t0\t0\t200\t60\n";

#define EXPECT_MENTIONS(text, part) EXPECT_NE(std::string(text).find(part), std::string::npos) << (text)

template <class Parse>
std::string complaint(Parse parse) {
  try {
    parse();
  } catch (const Error& error) {
    EXPECT_FALSE(error.hint.empty()) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "was read without complaint";
  return {};
}

TEST(Mtg, FollowsColumnsAndEdges) {
  const PlantGraph graph = parse_mtg(kTree, "t.mtg");
  std::vector<int> parents;
  std::vector<bool> begins;
  for (const GraphNode& node : graph.nodes)
    parents.push_back(node.parent), begins.push_back(node.begins_axis);
  EXPECT_EQ(parents, (std::vector<int>{-1, 0, 1, 2, 3, 4, 5, 4, 2, 8}));
  EXPECT_EQ(begins, (std::vector<bool>{false, false, false, true, false, true, false, false, false, false}));
  EXPECT_DOUBLE_EQ(graph.nodes[0].radius, 0.05);
}

TEST(Mtg, BranchesOfOneColumnHangOnItsAxis) {
  // As reconstructed trees are written: ^+B hangs a branch on the segment before, ^<S goes on behind it.
  const PlantGraph graph = parse_mtg(kHead +
                                         "ENTITY-CODE\t\t\tXX\tYY\tZZ\n/P1\t\t\n\t/A1\t\n\t\t/"
                                         "S1\t0\t0\t0\n\t\t^<S2\t0\t0\t1\n\t\t^+A2\t\n\t\t\t/S1\n"
                                         "\t\t^+A3\t\n\t\t^<S3\t0\t0\t2\n",
                                     "t.mtg");
  ASSERT_EQ(graph.nodes.size(), 3u);
  EXPECT_EQ(graph.nodes[2].parent, 1);
  EXPECT_FALSE(graph.nodes[2].begins_axis);
}

TEST(Mtg, ReadsChainsInOneCell) {
  const PlantGraph graph = parse_mtg(kHead +
                                         "ENTITY-CODE\tXX\tYY\tZZ\tTopDia\n/P1/A1/"
                                         "S1\t0\t0\t0\t20\n^<S2<S3\t0\t0\t40\t10\n^+A2/S1\t9\t0\t50\t4\n",
                                     "t.mtg");
  ASSERT_EQ(graph.nodes.size(), 3u);
  EXPECT_EQ(graph.nodes[1].parent, 0);
  EXPECT_EQ(graph.nodes[2].parent, 1);
  EXPECT_TRUE(graph.nodes[2].begins_axis);
}

// <<S9 stands for all from the one before up to S9, of which the file says no more: its axis goes straight to
// it.
TEST(Mtg, RangesGoStraightToTheirEnd) {
  const PlantGraph graph = parse_mtg(kHead +
                                         "ENTITY-CODE\tXX\tYY\tZZ\n/P1/A1/S1\t0\t0\t0\n^<<S9\t0\t0\t80\n"
                                         "^<S10\t0\t0\t90\n^++S3\t30\t0\t100\n^<S11\t0\t0\t110\n",
                                     "t.mtg");
  std::vector<int> parents;
  std::vector<bool> begins;
  for (const GraphNode& node : graph.nodes)
    parents.push_back(node.parent), begins.push_back(node.begins_axis);
  EXPECT_EQ(parents, (std::vector<int>{-1, 0, 1, 2, 2}));
  EXPECT_EQ(begins, (std::vector<bool>{false, false, false, true, false}));
  EXPECT_TRUE(std::any_of(graph.notes.begin(), graph.notes.end(),
                          [](const std::string& note) { return note.starts_with("2 ranges"); }));
}

TEST(Mtg, NamesLineAndReason) {
  const auto mtg = [](const std::string& rest) {
    return complaint([&] { parse_mtg(kHead + rest, "t.mtg"); });
  };
  EXPECT_MENTIONS(mtg("ENTITY-CODE\tL\n/P1\t1\n"), "no columns XX");
  EXPECT_MENTIONS(mtg("ENTITY-CODE\tXX\tYY\tZZ\n/P1\t1\t1,5\t2\n"), "'1,5' is not a number");
  EXPECT_MENTIONS(mtg("ENTITY-CODE\tXX\tYY\tZZ\n+A1\t1\t1\t2\n"),
                  "t.mtg:21: '+A1' has nothing that it grows from");
  EXPECT_MENTIONS(mtg("ENTITY-CODE\tXX\tYY\tZZ\n/P1\t\t\t\n"), "0 of its 1 entities have a position");
  EXPECT_MENTIONS(mtg("/P1\n"), "before the line ENTITY-CODE");
  EXPECT_MENTIONS(complaint([] { parse_mtg("nothing", "t.mtg"); }), "no section MTG");
}

TEST(FillRadii, InterpolatesAndFollowsThePipeModel) {
  PlantGraph graph;
  const auto add = [&](int parent, const Vec3& at, double radius, bool begins = false) {
    graph.nodes.push_back({at, parent, radius, begins});
  };
  add(-1, Vec3(0, 0, 0), NAN);  // carries 1 and nothing else: as thick as it
  add(0, Vec3(0, 1, 0), 0.05);
  add(1, Vec3(0, 2, 0), NAN);  // a quarter of the way to 0.01
  add(2, Vec3(0, 5, 0), 0.01);
  add(1, Vec3(1, 1, 0), NAN, true);  // carries two tips of the smallest radius
  add(4, Vec3(2, 1, 0), NAN);
  add(4, Vec3(2, 2, 0), NAN, true);
  EXPECT_EQ(fill_radii(graph), 5u);
  EXPECT_NEAR(graph.nodes[2].radius, 0.04, 1e-12);
  EXPECT_NEAR(graph.nodes[4].radius, std::sqrt(2.0) * 0.01, 1e-12);
  EXPECT_NEAR(graph.nodes[6].radius, 0.01, 1e-12);
  EXPECT_GE(graph.nodes[0].radius, 0.05);
}

TEST(BranchTubes, EveryAxisIsOneSolidTubeOnItsParent) {
  const ScratchFolder folder;
  std::ofstream(folder / "t.mtg") << kTree;
  const SegmentedPlant plant = load_plant(folder / "t.mtg");
  ASSERT_EQ(plant.domains.size(), 3u);
  EXPECT_EQ(plant.domains[1].parent, DomainId(0));
  EXPECT_EQ(plant.domains[2].parent, DomainId(1));
  const double lengths[] = {2, 0.04 + 0.27 + 0.32, 0.014 + 0.17};  // m, to the point
  for (size_t i = 0; i < 3; ++i) {
    const SolidDomain solid = make_solid(plant, DomainId(i));
    EXPECT_NEAR(solid.length, lengths[i], 0.1 * lengths[i]);
    EXPECT_GT(solid.volume, 0);
  }
  // The trunk: a cone frustum of radii 5 and 3 cm under 8 sides, 90.0 % of the circle's area.
  EXPECT_NEAR(make_solid(plant, DomainId(0)).volume, 0.9003 * kPi * 2 / 3 * (0.0025 + 0.0015 + 0.0009), 1e-4);
}

TEST(BranchTubes, LeavesOutPointsThatWouldFoldTheTube) {
  PlantGraph graph;
  for (int i = 0; i < 20; ++i)
    graph.nodes.push_back({Vec3(0.08 * (i % 2), 0.05 * i, 0.01 * (i % 3)), i - 1, 0.06});
  const SegmentedPlant plant = branch_tubes(graph, "x");
  ASSERT_EQ(plant.domains.size(), 1u);
  EXPECT_FALSE(self_intersects(plant.domains[0].surface));
  EXPECT_NO_THROW(make_solid(plant, DomainId(0)));
}

TEST(GraphFile, ReadsWhatItWrites) {
  PlantGraph graph = parse_mtg(kTree, "t.mtg");
  graph.nodes[3].radius = NAN;
  const PlantGraph back = parse_graph(graph_text(graph), "g.json");
  ASSERT_EQ(back.nodes.size(), graph.nodes.size());
  for (size_t i = 0; i < back.nodes.size(); ++i) {
    EXPECT_EQ(back.nodes[i].parent, graph.nodes[i].parent);
    EXPECT_EQ(back.nodes[i].begins_axis, graph.nodes[i].begins_axis);
    EXPECT_EQ(back.nodes[i].position, graph.nodes[i].position);
    EXPECT_EQ(std::isnan(back.nodes[i].radius), std::isnan(graph.nodes[i].radius));
  }
}

TEST(GraphFile, NamesTheNodeThatIsWrong) {
  const auto graph = [](const std::string& nodes) {
    return complaint([&] {
      parse_graph("{\"liana_graph\": 1, \"nodes\": [{\"position\": [0,0,0]}, " + nodes + "]}", "g.json");
    });
  };
  EXPECT_MENTIONS(graph("{\"position\": [0,0]}"), "node 1 has a position");
  EXPECT_MENTIONS(graph("{\"position\": [0,0,1], \"parent\": 1}"), "node 1 has a parent");
  EXPECT_MENTIONS(graph("{\"position\": [0,0,1], \"radius\": 0}"), "node 1 has a radius");
  EXPECT_MENTIONS(graph("{\"position\": [0,0,1], \"raduis\": 1}"), "unknown key 'raduis'");
  EXPECT_MENTIONS(graph("{}"), "node 1 has no position");
  EXPECT_MENTIONS(complaint([] { parse_graph("{\"liana_graph\": 1", "g.json"); }), "not JSON");
}

}  // namespace
}  // namespace liana

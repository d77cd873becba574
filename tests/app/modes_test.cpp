// liana modes and the files for ParaView, as a user gets them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mesher/base/files.h"
#include "tests/support/program.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

const std::string kSmallTree = LIANA_SOURCE_DIR "/data/plants/apple_small.glb";

// A VTU file by its XML alone, as JSON; base64 arrays are their 8-byte size and so many bytes.
constexpr const char* kReadVtu = R"(
import base64, json, struct, sys, xml.etree.ElementTree as xml
root = xml.parse(sys.argv[1]).getroot()
assert root.get('type') == 'UnstructuredGrid' and root.get('header_type') == 'UInt64', root.attrib
width = {'Float64': 8, 'Int64': 8, 'UInt8': 1}
def numbers(array):
    raw = base64.b64decode(array.text.strip(), validate=True)
    size = struct.unpack('<Q', raw[:8])[0]
    assert size == len(raw) - 8, (array.get('Name'), size, len(raw))
    code = {'Float64': 'd', 'Int64': 'q', 'UInt8': 'B'}[array.get('type')]
    return struct.unpack('<%d%s' % (size // width[array.get('type')], code), raw[8:])
piece = root.find('UnstructuredGrid/Piece')
points, cells = int(piece.get('NumberOfPoints')), int(piece.get('NumberOfCells'))
named = {a.get('Name'): (int(a.get('NumberOfComponents') or 1), numbers(a)) for a in root.iter('DataArray')}
connectivity = named['connectivity'][1]
assert list(named['offsets'][1]) == [10 * (i + 1) for i in range(cells)]
assert set(named['types'][1]) == {24} and len(named['types'][1]) == cells
assert len(connectivity) == 10 * cells and 0 <= min(connectivity) and max(connectivity) < points
assert len(piece.find('Points/DataArray').text) > 0 and len(numbers(piece.find('Points/DataArray'))) == 3 * points
sizes = {}
for place, count in (('PointData', points), ('CellData', cells)):
    for array in piece.find(place):
        components, values = named[array.get('Name')]
        assert len(values) == components * count and all(v == v for v in values), array.get('Name')
        sizes[array.get('Name')] = [place, components, min(values), max(values)]
print(json.dumps({'points': points, 'cells': cells, 'fields': sizes,
                  'frequencies': list(named['frequencies'][1]) if 'frequencies' in named else []}))
)";

class ModesVerb : public testing::Test {
 protected:
  nlohmann::json read_vtu(const std::string& name) {
    write_file(folder_ / "read.py", kReadVtu);
    const ProgramResult result = run_program("/usr/bin/python3", {"read.py", name}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out, nullptr, false);
  }
  ScratchFolder folder_;
};

// 6 %: a particle model of a dozen segments a branch with lumped joints against the tied T10 meshes, whose
// children are stiffer where they stand inside their parents.
TEST_F(ModesVerb, ParticlesMoveAsTheFiniteElementsOfTheWholePlantDo) {
  const ProgramResult result = run_liana(
      {"modes", kSmallTree, "--species", "apple", "--count", "4", "--json", "m.json", "--vtu", "m.vtu"},
      folder_.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json found = nlohmann::json::parse(read_file(folder_ / "m.json"));
  for (const char* key : {"plant", "domains", "united_by", "dof", "tied_nodes", "fe_converged", "fe_hz",
                          "particles_hz", "pairs"})
    EXPECT_TRUE(found.contains(key)) << key;
  EXPECT_TRUE(found["fe_converged"].get<bool>());
  ASSERT_EQ(found["pairs"].size(), 4u);
  for (size_t m = 0; m < 4; ++m) {
    // In order: the crown's modes are so near to each other that one like another may come first.
    EXPECT_NEAR(found["particles_hz"][m].get<double>() / found["fe_hz"][m].get<double>(), 1, 0.06)
        << "mode " << m + 1;
    EXPECT_GT(found["pairs"][m]["group_mac"].get<double>(), 0.85) << "mode " << m + 1;
  }

  const nlohmann::json vtu = read_vtu("m.vtu");
  ASSERT_TRUE(vtu.is_object());
  ASSERT_EQ(vtu["frequencies"].size(), 4u);
  for (int m = 0; m < 4; ++m) {
    EXPECT_DOUBLE_EQ(vtu["frequencies"][m].get<double>(), found["fe_hz"][m].get<double>());
    EXPECT_EQ(vtu["fields"]["mode" + std::to_string(m + 1)][1], 3);
  }
  EXPECT_EQ(vtu["fields"]["domain"][3].get<double>() + 1, found["domains"].get<double>());
}

TEST_F(ModesVerb, TetsOfABakeCarryTheirMaterials) {
  const ProgramResult result = run_liana({"bake", kSmallTree, "--species", "apple", "-o", "s.bake",
                                          "--report", "s.json", "--vtu", "s.vtu", "--no-cache"},
                                         folder_.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json vtu = read_vtu("s.vtu"), report = nlohmann::json::parse(read_file(folder_ / "s.json"));
  ASSERT_TRUE(vtu.is_object());
  EXPECT_EQ(vtu["fields"]["mode"][1], 3);
  EXPECT_LE(vtu["fields"]["mode"][3].get<double>(), 1);
  for (const char* name : {"nu", "E", "density"}) EXPECT_GT(vtu["fields"][name][2].get<double>(), 0) << name;
  EXPECT_EQ(vtu["fields"]["domain"][3].get<double>() + 1, double(report["domains"].size()));
}

TEST_F(ModesVerb, BakeGivesTheParticlesAlone) {
  ASSERT_EQ(run_liana({"bake", kSmallTree, "--species", "apple", "-o", "s.bake"}, folder_.path()).exit_code,
            0);
  const ProgramResult result =
      run_liana({"modes", "s.bake", "--count", "3", "--json", "m.json"}, folder_.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json found = nlohmann::json::parse(read_file(folder_ / "m.json"));
  EXPECT_EQ(found["particles_hz"].size(), 3u);
  EXPECT_FALSE(found.contains("fe_hz"));
  EXPECT_EQ(run_liana({"modes", "s.bake", "--vtu", "m.vtu"}, folder_.path()).exit_code, 2);
}

}  // namespace
}  // namespace liana

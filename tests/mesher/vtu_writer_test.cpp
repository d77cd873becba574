// Counts and sizes of what ParaView will read.
#include "mesher/io/vtu_writer.h"

#include <gtest/gtest.h>

#include <cstring>

#include "mesher/base/files.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

/// The bytes of the array of this name, after its 8-byte size, which must be their number.
std::string array_bytes(const std::string& text, const std::string& name) {
  const size_t begin = text.find('>', text.find("Name=\"" + name + "\"")) + 1;
  const std::string code = text.substr(begin, text.find('<', begin) - begin);
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  uint32_t bits = 0;
  int held = 0;
  for (const char c : code) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<uint32_t>(digits.find(c));
    if ((held += 6) >= 8) held -= 8, bytes += static_cast<char>(bits >> held & 255);
  }
  uint64_t size = 0;
  std::memcpy(&size, bytes.data(), 8);
  EXPECT_EQ(size, bytes.size() - 8) << name;
  EXPECT_EQ(code.size() % 4, 0u) << name;
  return bytes.substr(8);
}

TEST(VtuWriter, WritesEveryNumberBack) {
  VtuMesh mesh;
  for (int i = 0; i < 11; ++i) mesh.points.push_back(Vec3(i, 0.1 * i, -i));
  for (uint32_t i = 0; i < 10; ++i) mesh.cells.push_back(i);
  for (uint32_t i = 0; i < 10; ++i) mesh.cells.push_back(10 - i);
  mesh.point_fields = {{"mode", 3, std::vector<double>(33, 0.25)}};
  mesh.cell_fields = {{"E <&>", 1, {1e9, 2e9}}};
  mesh.numbers = {{"frequencies", 1, {1.5}}};
  const ScratchFolder folder;
  write_vtu(mesh, folder.path() / "a.vtu");
  const std::string text = read_file(folder.path() / "a.vtu");
  EXPECT_NE(text.find("NumberOfPoints=\"11\" NumberOfCells=\"2\""), std::string::npos);
  EXPECT_NE(text.find("E &lt;&amp;>"), std::string::npos);
  EXPECT_EQ(array_bytes(text, "Points").size(), 33 * sizeof(double));
  EXPECT_EQ(array_bytes(text, "mode").size(), 33 * sizeof(double));
  EXPECT_EQ(array_bytes(text, "types"), std::string(2, 24));
  const std::string connectivity = array_bytes(text, "connectivity");
  ASSERT_EQ(connectivity.size(), 20 * sizeof(int64_t));
  int64_t first_of_second;
  std::memcpy(&first_of_second, connectivity.data() + 80, 8);
  EXPECT_EQ(first_of_second, 10);
  double y;
  std::memcpy(&y, array_bytes(text, "Points").data() + 8 * 4, 8);
  EXPECT_EQ(y, 0.1);
}

}  // namespace
}  // namespace liana

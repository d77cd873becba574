// OBJ and PLY as files in the wild are, and as OpenMesh writes them.
#include <gtest/gtest.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/base/memory.h"
#include "mesher/geometry/mesh_checks.h"
#include "mesher/io/triangle_soup.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

double area(const TriangleSoup& soup) {
  return surface_area({soup.positions, soup.triangles});
}

template <class Parse>
std::string complaint(Parse parse) {
  try {
    parse();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, Error::Kind::Input);
    EXPECT_FALSE(error.hint.empty()) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "was read without complaint";
  return {};
}

std::string obj_complaint(const std::string& text) {
  return complaint([&] { parse_obj(text, "x.obj"); });
}
std::string ply_complaint(const std::string& text) {
  return complaint([&] { parse_ply(text, "x.ply"); });
}

#define EXPECT_MENTIONS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

TEST(ObjReader, ReadsSevenNumbersColoursCrlfAndMissingNormals) {
  const TriangleSoup soup = parse_obj(
      "# x\r\nv 0 0 0 1 0.5 0.5 0.5\r\nv +1 0 0 1 1 1 1\r\nv 1 1 0\r\nv 0 1e0 0 1\r\n\r\nf 1//7 2/3 3/1/1 "
      "4\r\n",
      "x.obj");
  EXPECT_EQ(soup.positions.size(), 4u);
  EXPECT_EQ(soup.triangles.size(), 2u);
  EXPECT_DOUBLE_EQ(area(soup), 1);
}

TEST(ObjReader, CountsNegativeIndicesFromTheLastVertex) {
  const TriangleSoup soup = parse_obj("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\n", "x.obj");
  EXPECT_EQ(soup.triangles[0], (Triangle{1, 2, 3}));
}

TEST(ObjReader, AllowsVerticesAfterTheFacesThatNameThem) {
  EXPECT_DOUBLE_EQ(area(parse_obj("f 1 2 3 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n", "x.obj")), 1);
}

TEST(ObjReader, JoinsContinuedLines) {
  EXPECT_EQ(parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 \\\n 2 \\\n3\n", "x.obj").triangles.size(), 1u);
}

TEST(ObjReader, KeepsTheOutlineOfConcavePolygons) {
  // An arrow head: the fan from its first corner would cover 2 x 2 / 2 + ... more than its area of 1.
  const TriangleSoup soup = parse_obj("v 0 0 0\nv 1 1 0\nv 2 0 0\nv 1 2 0\nf 1 2 3 4\n", "x.obj");
  EXPECT_DOUBLE_EQ(area(soup), 1);
}

TEST(ObjReader, LabelsByObjectElseGroupAndMaterial) {
  const TriangleSoup soup = parse_obj(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\ng bark side\nf 1 2 3\nusemtl Leaf Green\nf 1 2 3\no tree\nf 1 2 3\n",
      "x.obj");
  ASSERT_EQ(soup.labels.size(), 3u);
  EXPECT_EQ(soup.labels[soup.label[0]].object, "bark side");
  EXPECT_EQ(soup.labels[soup.label[1]].material, "Leaf Green");
  EXPECT_EQ(soup.labels[soup.label[2]].object, "tree");
}

TEST(ObjReader, SaysWhatItPassedOver) {
  const TriangleSoup soup = parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2\nsurf 1\nf 1 2 3\n", "x.obj");
  ASSERT_EQ(soup.notes.size(), 2u);
  EXPECT_MENTIONS(soup.notes[1], "line 5: 'surf'");
}

TEST(ObjReader, NamesFileLineAndRemedy) {
  EXPECT_MENTIONS(obj_complaint("v 0 0 0\nv 1 zero 0\n"), "x.obj:2: 'zero'");
  EXPECT_MENTIONS(obj_complaint("v 0 0\n"), "x.obj:1:");
  EXPECT_MENTIONS(obj_complaint("v 0 0 nan\n"), "x.obj:1:");
  EXPECT_MENTIONS(obj_complaint("v 0 0 0\nf 1 1 0\n"), "x.obj:2: a face names vertex '0'");
  EXPECT_MENTIONS(obj_complaint("v 0 0 0\nf 1 1 -2\n"), "x.obj:2:");
  EXPECT_MENTIONS(obj_complaint("v 0 0 0\n\nf 1 1 9\n"),
                  "x.obj:3: a face names vertex 9, and the file has 1");
  EXPECT_MENTIONS(obj_complaint("v 0 0 0\nv 1 1 1\nl 1 2\n"), "holds no faces");
  EXPECT_MENTIONS(obj_complaint(""), "holds no faces");
}

/// A tube with both lids, through OpenMesh into a file and back.
template <class Parse>
void expect_openmesh_roundtrip(const std::string& extension, OpenMesh::IO::Options options, Parse parse) {
  using OpenMeshMesh = OpenMesh::PolyMesh_ArrayKernelT<>;
  const Mesh tube = make_prism(7, 0.5, 0.1).mesh;
  OpenMeshMesh out;
  for (const Vec3& p : tube.positions)
    out.add_vertex(OpenMeshMesh::Point(float(p.x()), float(p.y()), float(p.z())));
  for (const Triangle& t : tube.triangles)
    out.add_face(OpenMesh::VertexHandle(int(t[0])), OpenMesh::VertexHandle(int(t[1])),
                 OpenMesh::VertexHandle(int(t[2])));
  const ScratchFolder folder;
  ASSERT_TRUE(OpenMesh::IO::write_mesh(out, (folder / ("m" + extension)).string(), options));
  const TriangleSoup soup = parse(read_file(folder / ("m" + extension)), "m" + extension);
  ASSERT_EQ(soup.triangles, tube.triangles);
  for (size_t i = 0; i < tube.positions.size(); ++i)  // floats, in text with six digits
    EXPECT_LT((soup.positions[i] - tube.positions[i]).norm(), 2e-6);
}

TEST(ObjReader, ReadsWhatOpenMeshWrites) {
  expect_openmesh_roundtrip(".obj", {}, parse_obj);
}

TEST(PlyReader, ReadsWhatOpenMeshWrites) {
  using Options = OpenMesh::IO::Options;
  expect_openmesh_roundtrip(".ply", Options(Options::Default), parse_ply);
  expect_openmesh_roundtrip(".ply", Options(Options::Binary), parse_ply);
  expect_openmesh_roundtrip(".ply", Options(Options::Binary | Options::MSB), parse_ply);
}

TEST(RequireMemory, SaysHowMuchIsNeededAndFree) {
  EXPECT_NO_THROW(require_memory(1 << 20, "a small mesh"));
  EXPECT_MENTIONS(complaint([] { require_memory(size_t{1} << 60, "a huge mesh"); }),
                  "a huge mesh needs about");
}

const std::string kHead =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty float y\nproperty float z\n";

TEST(PlyReader, PassesOverOtherElementsAndProperties) {
  const TriangleSoup soup = parse_ply(
      "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty uchar red\r\nproperty float z\r\nproperty "
      "float y\r\n"
      "property float x\r\nelement edge 1\r\nproperty list uchar int a\r\nelement face 1\r\nproperty list "
      "uchar float "
      "texcoord\r\nproperty list int short vertex_index\r\nend_header\r\n7 0 0 0\r\n7 0 0 1\r\n7 0 2 0\r\n2 "
      "8 9\r\n1 "
      ".5 3 0 1 2\r\n",
      "x.ply");
  EXPECT_DOUBLE_EQ(area(soup), 1);
}

TEST(PlyReader, NamesWhatIsWrong) {
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string points = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  EXPECT_MENTIONS(ply_complaint("plx\n"), "x.ply:1:");
  EXPECT_MENTIONS(ply_complaint("ply\nformat ascii 1.0\nelement vertex many\n"), "x.ply:3:");
  EXPECT_MENTIONS(ply_complaint("ply\nformat binary 1.0\n"), "x.ply:2: unknown format");
  EXPECT_MENTIONS(ply_complaint(kHead + faces + points + "3 0 1 4\n"), "x.ply:14: face 0 names vertex 4");
  EXPECT_MENTIONS(ply_complaint(kHead + faces + points + "3 0 1\n"), "face 0");
  EXPECT_MENTIONS(ply_complaint(kHead + faces + "0 0 0\n1 0 0\n1 nan 0\n0 1 0\n"), "x.ply:12: vertex 2");
  EXPECT_MENTIONS(ply_complaint(kHead + "end_header\n" + points), "holds no faces (4 points)");
  EXPECT_MENTIONS(ply_complaint("ply\nformat binary_little_endian 1.0\nelement vertex "
                                "99999999999999\nproperty float x\nend_header\n"),
                  "do not fit");
}

}  // namespace
}  // namespace liana

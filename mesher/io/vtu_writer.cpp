#include "mesher/io/vtu_writer.h"

#include <fmt/core.h>

#include "mesher/base/error.h"
#include "mesher/base/files.h"

namespace liana {
namespace {

constexpr uint8_t kQuadraticTetra = 24;  // VTK's number

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(bytes.size() / 3 * 4 + 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t triple = 0;
    for (size_t k = 0; k < 3; ++k) triple = triple << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? kDigits[triple >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// Names come from foreign files.
std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name)
    text += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c == '"' ? "&quot;" : std::string(1, c);
  return text;
}

template <class Number>
std::string array(const std::string& attributes, const std::vector<Number>& values) {
  const uint64_t size = values.size() * sizeof(Number);
  std::string bytes(reinterpret_cast<const char*>(&size), sizeof size);
  bytes.append(reinterpret_cast<const char*>(values.data()), size);
  return fmt::format("<DataArray {} format=\"binary\">{}</DataArray>\n", attributes, base64(bytes));
}

std::string fields(const char* tag, const std::vector<VtuField>& fields, size_t count) {
  std::string text = fmt::format("<{}>\n", tag);
  for (const VtuField& field : fields) {
    require(field.values.size() == count * field.components, "a field has a value for each point or cell");
    text += array(fmt::format("type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\"", escaped(field.name),
                              field.components),
                  field.values);
  }
  return text + fmt::format("</{}>\n", tag);
}

}  // namespace

void write_vtu(const VtuMesh& mesh, const std::filesystem::path& path) {
  const size_t cells = mesh.cells.size() / 10;
  std::vector<double> points;
  for (const Vec3& p : mesh.points) points.insert(points.end(), {p.x(), p.y(), p.z()});
  std::vector<int64_t> connectivity(mesh.cells.begin(), mesh.cells.end()), offsets;
  for (size_t c = 1; c <= cells; ++c) offsets.push_back(static_cast<int64_t>(10 * c));
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n";
  text += "<FieldData>\n";
  for (const VtuField& field : mesh.numbers)
    text += array(fmt::format("type=\"Float64\" Name=\"{}\" NumberOfTuples=\"{}\"", escaped(field.name),
                              field.values.size()),
                  field.values);
  text += fmt::format("</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
                      mesh.points.size(), cells);
  text += "<Points>\n" + array("type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", points) +
          "</Points>\n";
  text += "<Cells>\n" + array("type=\"Int64\" Name=\"connectivity\"", connectivity) +
          array("type=\"Int64\" Name=\"offsets\"", offsets) +
          array("type=\"UInt8\" Name=\"types\"", std::vector<uint8_t>(cells, kQuadraticTetra)) + "</Cells>\n";
  text += fields("PointData", mesh.point_fields, mesh.points.size());
  text += fields("CellData", mesh.cell_fields, cells);
  text += "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  write_file(path, text);
}

}  // namespace liana

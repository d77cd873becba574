#include "mesher/io/gltf_model.h"

#include <fmt/core.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"

namespace liana {
namespace {
namespace fs = std::filesystem;

constexpr size_t kMaxFileBytes = size_t{1} << 30;
const char* const kExportAgain =
    "export it again as plain glTF 2.0 (no compression), or check that the file is complete";

/// What tinygltf's file callbacks need: buffers may only come from the file's own folder.
struct Folder {
  fs::path path;
  uint64_t hash = 0;  ///< over every buffer read

  bool holds(const std::string& file) const {
    std::error_code code;
    const fs::path inside = fs::weakly_canonical(file, code).lexically_relative(fs::weakly_canonical(path));
    return !code && !inside.empty() && *inside.begin() != "..";
  }
};

bool buffer_exists(const std::string& file, void* data) {
  std::error_code code;
  return static_cast<Folder*>(data)->holds(file) && fs::is_regular_file(file, code);
}

bool read_buffer(std::vector<unsigned char>* bytes, std::string* error, const std::string& file, void* data) {
  auto& folder = *static_cast<Folder*>(data);
  try {
    if (!folder.holds(file))
      throw Error(Error::Kind::Input, file + ": lies outside the folder of the glTF file");
    const std::string text = read_file(file, kMaxFileBytes);
    folder.hash = hash_bytes(text.data(), text.size(), folder.hash);
    bytes->assign(text.begin(), text.end());
    return true;
  } catch (const Error& reason) {
    if (error) *error += reason.what();
    return false;
  }
}

bool ignore_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*,
                  int, void*) {
  return true;
}

/// One line of what tinygltf has to say.
std::string first_line(std::string text) {
  text.erase(std::min(text.find('\n'), text.size()));
  return text.empty() ? "not a glTF file" : text;
}

struct View {
  const unsigned char* data;
  size_t count, stride;
};

/// The bytes of an accessor, checked against its buffer. element_size in bytes.
View accessor_view(const tinygltf::Model& model, int index, size_t element_size, const std::string& where) {
  const auto fail = [&](const std::string& reason) {
    return Error(Error::Kind::Input, fmt::format("{}: accessor {} {}", where, index, reason), kExportAgain);
  };
  const tinygltf::Accessor& accessor = model.accessors[index];
  if (accessor.sparse.isSparse) throw fail("is sparse, which is not supported");
  if (accessor.bufferView < 0 || size_t(accessor.bufferView) >= model.bufferViews.size())
    throw fail("names a buffer view that does not exist");
  const tinygltf::BufferView& view = model.bufferViews[accessor.bufferView];
  if (view.buffer < 0 || size_t(view.buffer) >= model.buffers.size())
    throw fail("names a buffer that does not exist");
  const std::vector<unsigned char>& bytes = model.buffers[view.buffer].data;
  if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset)
    throw fail("has a buffer view that reaches beyond its buffer");
  const size_t stride = view.byteStride ? view.byteStride : element_size;
  if (stride < element_size) throw fail("has a stride smaller than its elements");
  if (accessor.count == 0 || accessor.byteOffset > view.byteLength ||
      element_size > view.byteLength - accessor.byteOffset ||
      accessor.count - 1 > (view.byteLength - accessor.byteOffset - element_size) / stride)
    throw fail("is empty or reaches beyond its buffer view");
  return {bytes.data() + view.byteOffset + accessor.byteOffset, accessor.count, stride};
}

std::vector<Vec3> read_positions(const tinygltf::Model& model, int index, const std::string& where) {
  if (index < 0 || size_t(index) >= model.accessors.size())
    throw Error(Error::Kind::Input, where + ": its positions name an accessor that does not exist",
                kExportAgain);
  const tinygltf::Accessor& accessor = model.accessors[index];
  if (accessor.type != TINYGLTF_TYPE_VEC3 || accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
    throw Error(Error::Kind::Input, where + ": positions are not three floats (quantized or compressed mesh)",
                kExportAgain);
  const View view = accessor_view(model, index, 3 * sizeof(float), where);
  std::vector<Vec3> positions(view.count);
  for (size_t i = 0; i < view.count; ++i) {
    std::array<float, 3> p;
    std::memcpy(p.data(), view.data + i * view.stride, sizeof(p));
    positions[i] = Vec3(p[0], p[1], p[2]);
    if (!positions[i].allFinite())
      throw Error(Error::Kind::Input, fmt::format("{}: position {} is not a finite number", where, i),
                  "repair the mesh in the program that made it");
  }
  return positions;
}

std::vector<uint32_t> read_indices(const tinygltf::Model& model, int index, size_t vertices,
                                   const std::string& where) {
  if (size_t(index) >= model.accessors.size())
    throw Error(Error::Kind::Input, where + ": its indices name an accessor that does not exist",
                kExportAgain);
  const tinygltf::Accessor& accessor = model.accessors[index];
  const size_t size = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE    ? 1
                      : accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 2
                      : accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT   ? 4
                                                                                         : 0;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || size == 0)
    throw Error(Error::Kind::Input, where + ": its indices are not unsigned integers", kExportAgain);
  const View view = accessor_view(model, index, size, where);
  std::vector<uint32_t> indices(view.count);
  for (size_t i = 0; i < view.count; ++i) {
    std::memcpy(&indices[i], view.data + i * view.stride, size);  // little-endian, as glTF and our machines
    if (indices[i] >= vertices)
      throw Error(Error::Kind::Input,
                  fmt::format("{}: index {} names vertex {} of {}", where, i, indices[i], vertices),
                  kExportAgain);
  }
  return indices;
}

/// Appends the triangles of a list, strip or fan, as glTF 2.0 §3.7.2.1 winds them.
void append_triangles(int mode, const std::vector<uint32_t>& corners, uint32_t first,
                      std::vector<Triangle>& out) {
  const auto add = [&](size_t a, size_t b, size_t c) {
    out.push_back({first + corners[a], first + corners[b], first + corners[c]});
  };
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    for (size_t i = 0; i + 2 < corners.size(); ++i) add(i, i + 1 + i % 2, i + 2 - i % 2);
  } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
    for (size_t i = 0; i + 2 < corners.size(); ++i) add(i + 1, i + 2, 0);
  } else {
    for (size_t i = 0; i + 2 < corners.size(); i += 3) add(i, i + 1, i + 2);
  }
}

}  // namespace

uint64_t load_gltf(const fs::path& path, tinygltf::Model& model) {
  return load_gltf_bytes(read_file(path, kMaxFileBytes), path, model);
}

uint64_t load_gltf_bytes(const std::string& bytes, const fs::path& path, tinygltf::Model& model) {
  Folder folder{fs::absolute(path).parent_path(), hash_bytes(bytes.data(), bytes.size())};
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(
      {buffer_exists, [](const std::string& name, void*) { return name; }, read_buffer, nullptr, &folder});
  loader.SetImageLoader(ignore_image, nullptr);
  std::string error, warning;
  bool loaded = false;
  const std::string base = folder.path.string();
  const auto size = static_cast<unsigned>(bytes.size());
  try {
    loaded =
        bytes.compare(0, 4, "glTF") == 0
            ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(bytes.data()), size, base)
            : loader.LoadASCIIFromString(&model, &error, &warning, bytes.data(), size, base);
  } catch (
      const std::exception& reason) {  // the JSON library and the allocator can still throw through tinygltf
    error = reason.what();
  }
  if (!loaded)
    throw Error(Error::Kind::Input,
                fmt::format("{}: not a readable glTF file ({})", path.string(), first_line(error)),
                "give a complete .glb or .gltf file, glTF version 2");
  for (const std::string& extension : model.extensionsRequired)
    if (extension.rfind("KHR_materials_", 0) != 0 && extension.rfind("KHR_texture_", 0) != 0)
      throw Error(Error::Kind::Input,
                  fmt::format("{}: needs the glTF extension {}", path.string(), extension), kExportAgain);
  return folder.hash;
}

Mesh gltf_mesh(const tinygltf::Model& model, int mesh, const std::string& where,
               std::vector<int>* materials) {
  if (mesh < 0 || size_t(mesh) >= model.meshes.size())
    throw Error(Error::Kind::Input, fmt::format("{}: names mesh {}, which does not exist", where, mesh),
                kExportAgain);
  Mesh result;
  for (const tinygltf::Primitive& primitive : model.meshes[mesh].primitives) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN)
      throw Error(Error::Kind::Input, fmt::format("{}: consists of points or lines (mode {})", where, mode),
                  "a domain is a surface of triangles: convert the object to a mesh before exporting");
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end())
      throw Error(Error::Kind::Input, where + ": its mesh has no positions", kExportAgain);
    const std::vector<Vec3> positions = read_positions(model, position->second, where);
    std::vector<uint32_t> corners;
    if (primitive.indices >= 0) {
      corners = read_indices(model, primitive.indices, positions.size(), where);
    } else {
      corners.resize(positions.size());
      for (size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<uint32_t>(i);
    }
    if (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0)
      throw Error(Error::Kind::Input,
                  fmt::format("{}: {} corners do not make whole triangles", where, corners.size()),
                  kExportAgain);
    append_triangles(mode, corners, static_cast<uint32_t>(result.positions.size()), result.triangles);
    result.positions.insert(result.positions.end(), positions.begin(), positions.end());
    if (materials) materials->resize(result.triangles.size(), primitive.material);
  }
  if (result.triangles.empty())
    throw Error(Error::Kind::Input, where + ": its mesh is empty",
                "give it triangles, or remove the mesh from the node so that it only carries its transform");
  return result;
}

}  // namespace liana

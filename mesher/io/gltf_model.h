// Files as tinygltf models, and their meshes, with the checks that tinygltf leaves out: it accepts accessors
// beyond their buffer, ids of nothing and URIs that leave the folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "mesher/geometry/mesh.h"

namespace tinygltf {
class Model;
}

namespace liana {

/// Loads .glb or .gltf (told apart by content) with its buffers; images are not decoded. Returns the hash of
/// all bytes. Throws Error{Input} naming the file.
uint64_t load_gltf(const std::filesystem::path& path, tinygltf::Model& model);

/// The same from memory; `path` names it in messages, and buffers are looked for in its folder.
uint64_t load_gltf_bytes(const std::string& bytes, const std::filesystem::path& path, tinygltf::Model& model);

/// All triangles of a mesh, as stored (not welded). `where` names file and node in messages.
/// `materials`, if given, takes the material of every triangle (-1: none). Throws Error{Input} for anything
/// but finite float positions and triangles with valid indices.
Mesh gltf_mesh(const tinygltf::Model& model, int mesh, const std::string& where,
               std::vector<int>* materials = nullptr);

}  // namespace liana

// DrawScene -> binary glTF 2.0: what other programs open.
#pragma once

#include <filesystem>

#include "runtime/picture/draw_scene.h"

namespace liana {

struct GltfExportOptions {
  int tube_sides = 10;
};

/// Metres, +Y up. Every branch and obstacle is a named node with its mesh; every leaf is a named node that
/// shares one mesh per outline (no extension needed), scaled to its size. The file appears only when
/// complete. Throws Error{Output} when it cannot be written, Error{Usage} for a scene without anything in it.
void write_gltf(const std::filesystem::path& path, const DrawScene& scene,
                const GltfExportOptions& options = {});

}  // namespace liana

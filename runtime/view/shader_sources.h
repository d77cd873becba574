// The text of runtime/view/shaders/, embedded at build time.
#pragma once

#include <string_view>
#include <vector>

namespace liana {

struct ShaderSource {
  std::string_view name;  ///< file name, as "leaf.frag"
  std::string_view text;
};

extern const std::vector<ShaderSource> kShaderSources;

}  // namespace liana

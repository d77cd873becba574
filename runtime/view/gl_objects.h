// Owners of OpenGL objects. All need the context that was current at their making to be current.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <string>
#include <utility>

namespace liana {

enum class GlKind { Buffer, VertexArray, Texture, Framebuffer, Renderbuffer };

/// One OpenGL object, deleted with its owner.
class GlObject {
 public:
  explicit GlObject(GlKind kind);
  GlObject(GlObject&& other) noexcept : kind_(other.kind_), id_(std::exchange(other.id_, 0)) {}
  GlObject& operator=(GlObject&& other) noexcept {
    std::swap(kind_, other.kind_);
    std::swap(id_, other.id_);
    return *this;
  }
  ~GlObject();
  unsigned id() const { return id_; }

 private:
  GlKind kind_;
  unsigned id_ = 0;
};

/// A vertex and a fragment shader, linked. Names are files of runtime/view/shaders; "common.glsl" stands
/// before each, and "light.glsl" before fragment shaders. Throws std::logic_error with the compiler's log:
/// the shaders are ours.
class ShaderProgram {
 public:
  ShaderProgram(const std::string& vertex_file, const std::string& fragment_file);
  ShaderProgram(const ShaderProgram&) = delete;
  ShaderProgram& operator=(const ShaderProgram&) = delete;
  ~ShaderProgram();

  void use() const;
  // The program must be in use. A name that the compiler optimised away is ignored.
  void set(const char* name, int value);
  void set(const char* name, float value);
  void set(const char* name, const glm::vec2& value);
  void set(const char* name, const glm::vec3& value);
  void set(const char* name, const glm::mat4& value);

 private:
  int location(const char* name);

  unsigned id_ = 0;
  std::map<std::string, int> locations_;
};

}  // namespace liana

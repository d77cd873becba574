#include "runtime/view/gl_objects.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>
#include <stdexcept>

#include "mesher/base/error.h"
#include "runtime/view/shader_sources.h"

namespace liana {
namespace {

std::string source_of(const std::string& name) {
  const auto found = std::find_if(kShaderSources.begin(), kShaderSources.end(),
                                  [&](const ShaderSource& s) { return s.name == name; });
  require(found != kShaderSources.end(), "no such shader file");
  return std::string(found->text);
}

unsigned compiled(GLenum kind, const std::string& file) {
  const std::string text = source_of("common.glsl") +
                           (kind == GL_FRAGMENT_SHADER ? source_of("light.glsl") : "") + source_of(file);
  const char* pointer = text.c_str();
  const unsigned shader = glCreateShader(kind);
  glShaderSource(shader, 1, &pointer, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good) {
    char log[4096] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw std::logic_error(file + ": " + log);
  }
  return shader;
}

}  // namespace

GlObject::GlObject(GlKind kind) : kind_(kind) {
  switch (kind_) {
    case GlKind::Buffer:
      glGenBuffers(1, &id_);
      break;
    case GlKind::VertexArray:
      glGenVertexArrays(1, &id_);
      break;
    case GlKind::Texture:
      glGenTextures(1, &id_);
      break;
    case GlKind::Framebuffer:
      glGenFramebuffers(1, &id_);
      break;
    case GlKind::Renderbuffer:
      glGenRenderbuffers(1, &id_);
      break;
  }
}

GlObject::~GlObject() {
  if (id_ == 0) return;
  switch (kind_) {
    case GlKind::Buffer:
      glDeleteBuffers(1, &id_);
      break;
    case GlKind::VertexArray:
      glDeleteVertexArrays(1, &id_);
      break;
    case GlKind::Texture:
      glDeleteTextures(1, &id_);
      break;
    case GlKind::Framebuffer:
      glDeleteFramebuffers(1, &id_);
      break;
    case GlKind::Renderbuffer:
      glDeleteRenderbuffers(1, &id_);
      break;
  }
}

ShaderProgram::ShaderProgram(const std::string& vertex_file, const std::string& fragment_file) {
  const unsigned vertex = compiled(GL_VERTEX_SHADER, vertex_file);
  const unsigned fragment = compiled(GL_FRAGMENT_SHADER, fragment_file);
  id_ = glCreateProgram();
  glAttachShader(id_, vertex);
  glAttachShader(id_, fragment);
  glLinkProgram(id_);
  glDeleteShader(vertex);
  glDeleteShader(fragment);
  GLint good = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &good);
  if (!good) {
    char log[4096] = "";
    glGetProgramInfoLog(id_, sizeof log, nullptr, log);
    glDeleteProgram(id_);
    throw std::logic_error(vertex_file + " with " + fragment_file + ": " + log);
  }
}

ShaderProgram::~ShaderProgram() {
  glDeleteProgram(id_);
}

void ShaderProgram::use() const {
  glUseProgram(id_);
}

int ShaderProgram::location(const char* name) {
  const auto [entry, is_new] = locations_.try_emplace(name, -1);
  if (is_new) entry->second = glGetUniformLocation(id_, name);
  return entry->second;
}

void ShaderProgram::set(const char* name, int value) {
  glUniform1i(location(name), value);
}
void ShaderProgram::set(const char* name, float value) {
  glUniform1f(location(name), value);
}
void ShaderProgram::set(const char* name, const glm::vec2& value) {
  glUniform2fv(location(name), 1, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const glm::vec3& value) {
  glUniform3fv(location(name), 1, glm::value_ptr(value));
}
void ShaderProgram::set(const char* name, const glm::mat4& value) {
  glUniformMatrix4fv(location(name), 1, GL_FALSE, glm::value_ptr(value));
}

}  // namespace liana

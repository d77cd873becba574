layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal_in;
out vec3 world, normal;

void main() {
  world = position;
  normal = normal_in;
  gl_ClipDistance[0] = position.y + 0.02;
  gl_Position = view_projection * vec4(position, 1.0);
}

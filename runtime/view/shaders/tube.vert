layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal_in;
layout(location = 2) in vec3 bark_in;
layout(location = 3) in vec4 color_in;
out vec3 world, normal, bark, color;

void main() {
  world = position;
  normal = normal_in;
  bark = bark_in;
  color = unpacked(color_in);
  gl_ClipDistance[0] = position.y + 0.02;
  gl_Position = view_projection * vec4(position, 1.0);
}

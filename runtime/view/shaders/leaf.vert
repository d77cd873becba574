// One blade: the flat outline is folded along the midrib and bent; the same formulas as blade_point().
layout(location = 0) in vec2 shape;
layout(location = 1) in vec3 base;
layout(location = 2) in vec4 orientation;  // quaternion x y z w
layout(location = 3) in vec3 size;         // length, width, curl
layout(location = 4) in vec4 color_in;
uniform float fold;
out vec3 world, normal, color;
out vec2 blade;

vec3 turned(vec3 v) { return v + 2.0 * cross(orientation.xyz, cross(orientation.xyz, v) + orientation.w * v); }

void main() {
  float turn = abs(size.z) < 1e-3 ? 1e-3 : size.z, angle = turn * shape.y;
  float x = shape.x * size.y, lift = fold * abs(x), s = sin(angle), c = cos(angle), arm = size.x / turn;
  vec3 local = vec3(x, (arm + lift) * s, -arm * (1.0 - c) + lift * c);
  vec3 across = vec3(1.0, sign(x) * fold * s, sign(x) * fold * c), along = vec3(0.0, c, -s);
  world = base + turned(local);
  normal = turned(normalize(cross(across, along)));
  color = unpacked(color_in);
  blade = shape;
  gl_ClipDistance[0] = world.y + 0.02;
  gl_Position = view_projection * vec4(world, 1.0);
}

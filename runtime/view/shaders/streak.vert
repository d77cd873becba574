// A strip of the same width on the screen, between two points: four corners of one instance.
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in vec4 color_in;
out vec4 color;
uniform vec2 half_pixel;  // of the picture, in clip space

void main() {
  vec4 a = view_projection * vec4(from, 1.0), b = view_projection * vec4(to, 1.0);
  vec2 along = (b.xy / max(b.w, 1e-6) - a.xy / max(a.w, 1e-6)) / half_pixel;
  along = length(along) > 1e-3 ? normalize(along) : vec2(1.0, 0.0);
  bool far = gl_VertexID % 2 == 1, upper = gl_VertexID / 2 == 1;
  vec4 end = far ? b : a;
  // Nearly as wide as a pixel and a half; longer by half of that at both ends, so that a point is a dot.
  vec2 shift = 1.4 * ((far ? along : -along) + vec2(-along.y, along.x) * (upper ? 1.0 : -1.0));
  color = vec4(unpacked(color_in), color_in.a * (far ? 1.0 : 0.15));
  gl_Position = end + vec4(shift * half_pixel * end.w, 0.0, 0.0);
}

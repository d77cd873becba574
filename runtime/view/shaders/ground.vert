const float kReach = 1500.0;  // m

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  gl_Position = view_projection * vec4(eye.x + kReach * corner.x, 0.0, eye.z - kReach * corner.y, 1.0);
}

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0;  // a triangle larger than the screen
  gl_Position = vec4(corner, 1.0, 1.0);
}

uniform vec3 ray_corner, ray_right, ray_up;
out vec4 fragment;

void main() {
  vec3 direction = normalize(ray_corner + gl_FragCoord.x * ray_right + gl_FragCoord.y * ray_up);
  vec3 color = sky(direction);
  if (direction.y > 0.02) {
    vec2 p = direction.xz / (direction.y + 0.12);
    float cloud = smoothstep(0.50, 0.85, fractal(p * 0.8 + 3.0 * noise(p * 0.35)));
    color = mix(color, vec3(0.95, 0.96, 0.98), 0.55 * cloud * smoothstep(0.02, 0.30, direction.y));
  }
  color = color * (1.0 + color / 9.0) / (1.0 + color);
  fragment = vec4(pow(1.22 * color, vec3(1.0 / 2.2)), 0.0);
}

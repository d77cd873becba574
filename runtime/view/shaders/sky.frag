uniform vec3 ray_corner, ray_right, ray_up;
out vec4 fragment;

// Height of a far ridge over the horizon, as a slope; the pattern goes once round.
float ridge(vec2 heading, float scale, float seed) {
  return 0.5 * noise(heading * scale + seed) + 0.3 * noise(heading * scale * 2.7 + seed) +
         0.04 * noise(heading * scale * 26.0 + seed);
}

void main() {
  vec3 direction = normalize(ray_corner + gl_FragCoord.x * ray_right + gl_FragCoord.y * ray_up);
  vec3 color = sky(direction);
  float flat_length = length(direction.xz), slope = direction.y / max(flat_length, 1e-4);
  if (direction.y > 0.02) {
    vec2 p = direction.xz / (direction.y + 0.12);
    float cloud = smoothstep(0.48, 0.80, fractal(p * 0.8 + 3.0 * noise(p * 0.35)));
    color = mix(color, vec3(1.25, 1.22, 1.2), 0.65 * cloud * smoothstep(0.02, 0.30, direction.y));
  }
  if (abs(slope) < 0.12) {
    vec2 heading = direction.xz / max(flat_length, 1e-4);
    float edge = fwidth(slope);
    float far = 0.085 * ridge(heading, 2.3, 11.0), near = 0.05 * ridge(heading, 5.1, 4.0);
    color = mix(color, vec3(0.36, 0.47, 0.56), smoothstep(edge, -edge, slope - far) * 0.75);
    color = mix(color, vec3(0.25, 0.35, 0.30), smoothstep(edge, -edge, slope - near) * 0.8);
    color = mix(color, sky(direction), exp(-max(slope, 0.0) * 130.0) * 0.7);
  }
  fragment = vec4(developed(color), 0.0);
}

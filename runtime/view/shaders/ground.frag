// Soil with short grass. The point is where the pixel's ray meets y = 0: exact, however large the quad is.
uniform vec3 ray_corner, ray_right, ray_up;  // ray through pixel (x, y) = corner + x right + y up, y from below
out vec4 fragment;

void main() {
  vec3 ray = ray_corner + gl_FragCoord.x * ray_right + gl_FragCoord.y * ray_up;
  vec3 world = eye - ray * (eye.y / min(ray.y, -1e-6));
  vec2 p = world.xz;
  float distance = length(world - eye);
  float pixel = length(fwidth(p));
  float patches = fractal(p * 0.9 + 5.0), broad = noise(p * 0.13);
  float tufts = mix(noise(p * 24.0), 0.5, smoothstep(0.02, 0.08, pixel));
  float blades = mix(noise(vec2(p.x * 260.0 + 8.0 * tufts, p.y * 90.0)) * 0.6 + noise(p.yx * vec2(220.0, 80.0)) * 0.4, 0.5,
                     smoothstep(0.003, 0.014, pixel));
  float cover = smoothstep(0.30, 0.62, patches + 0.35 * (tufts - 0.5) + 0.15 * (broad - 0.5));
  vec3 grass = mix(vec3(0.062, 0.105, 0.024), vec3(0.16, 0.20, 0.055), 0.65 * blades + 0.35 * tufts);
  grass = mix(grass, vec3(0.20, 0.19, 0.075), 0.35 * broad);
  vec3 soil = mix(vec3(0.105, 0.075, 0.05), vec3(0.19, 0.145, 0.10), 0.5 * tufts + 0.5 * blades);
  vec3 albedo = mix(soil, grass, cover);
  vec3 n = bumped(vec3(0.0, 1.0, 0.0), world, 0.012 * tufts + 0.006 * blades * cover);
  float sun = max(dot(n, to_sun), 0.0) * sunlit(world, vec3(0.0, 1.0, 0.0));
  float hollow = 0.70 + 0.30 * blades;
  fragment = finished(kSunLight * sun * albedo, albedo * hollow * ambient(n), world);
}

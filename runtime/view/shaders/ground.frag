// Soil with short grass. The point is where the pixel's ray meets y = 0: exact, however large the quad is.
uniform vec3 ray_corner, ray_right, ray_up;  // ray through pixel (x, y) = corner + x right + y up, y from below
out vec4 fragment;

void main() {
  vec3 ray = ray_corner + gl_FragCoord.x * ray_right + gl_FragCoord.y * ray_up;
  vec3 world = eye - ray * (eye.y / min(ray.y, -1e-6));
  vec2 p = world.xz;
  float pixel = length(fwidth(p));
  float patches = fractal(p * 0.7 + 5.0), broad = noise(p * 0.11);
  // Clumps of 6 cm, tufts of 2 cm, blades of a few mm; each fades out before it is finer than the picture.
  float clumps = mix(0.5, noise(p * 16.0), 1.0 - smoothstep(0.02, 0.08, pixel));
  float tufts = mix(0.5, noise(p * 47.0 + 3.0), 1.0 - smoothstep(0.008, 0.03, pixel));
  vec2 lean = vec2(tufts, clumps) * 3.0;
  float blades = mix(0.5, 0.5 * noise(p * vec2(420.0, 110.0) + lean) + 0.5 * noise(p * vec2(120.0, 380.0) - lean),
                     1.0 - smoothstep(0.003, 0.012, pixel));
  float height = 0.35 * clumps + 0.35 * tufts + 0.30 * blades;
  float cover = smoothstep(0.16, 0.36, patches + 0.50 * (height - 0.5));
  vec3 grass = mix(vec3(0.027, 0.043, 0.010), vec3(0.112, 0.140, 0.040), smoothstep(0.15, 0.85, height));
  grass *= mix(vec3(0.75, 0.88, 0.85), vec3(1.35, 1.18, 1.0), 0.6 * patches + 0.4 * noise(p * 2.9));
  grass = mix(grass, vec3(0.115, 0.110, 0.045), 0.25 * broad);
  vec3 soil = mix(vec3(0.055, 0.038, 0.022), vec3(0.150, 0.112, 0.070), smoothstep(0.25, 0.8, height));
  vec3 albedo = mix(soil, grass, cover);
  vec3 n = bumped(vec3(0.0, 1.0, 0.0), world, 0.006 * clumps + 0.005 * tufts + 0.003 * blades);
  float sun = max(dot(n, to_sun), 0.0) * sunlit(world, vec3(0.0, 1.0, 0.0));
  fragment = finished(kSunLight * sun * albedo, albedo * ambient(n) * (0.6 + 0.5 * height), world);
}

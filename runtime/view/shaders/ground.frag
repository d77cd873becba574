// Soil with short grass. The point is where the pixel's ray meets y = 0: exact, however large the quad is.
uniform vec3 ray_corner, ray_right, ray_up;  // ray through pixel (x, y) = corner + x right + y up, y from below
out vec4 fragment;

void main() {
  vec3 ray = ray_corner + gl_FragCoord.x * ray_right + gl_FragCoord.y * ray_up;
  vec3 world = eye - ray * (eye.y / min(ray.y, -1e-6));
  vec2 p = world.xz;
  float pixel = length(fwidth(p));
  float patches = fractal(p * 0.7 + 5.0), broad = noise(p * 0.11);
  float tufts = mix(noise(p * 17.0 + 2.0 * noise(p * 5.0)), 0.5, smoothstep(0.02, 0.10, pixel));
  float leaning = 1.1 * noise(p * 1.3);
  vec2 q = mat2(cos(leaning), sin(leaning), -sin(leaning), cos(leaning)) * p;
  float blades = mix(0.6 * noise(q * vec2(330.0, 75.0)) + 0.4 * noise(q.yx * vec2(270.0, 60.0) + 9.0), 0.5,
                     smoothstep(0.004, 0.016, pixel));
  float cover = smoothstep(0.18, 0.40, patches + 0.40 * (tufts - 0.5) + 0.25 * (blades - 0.5));
  vec3 grass = mix(vec3(0.028, 0.043, 0.012), vec3(0.125, 0.150, 0.048), blades * blades * 1.2 + 0.30 * tufts);
  grass *= 0.75 + 0.5 * patches;
  grass = mix(grass, vec3(0.13, 0.125, 0.045), 0.30 * broad);
  vec3 soil = mix(vec3(0.060, 0.042, 0.024), vec3(0.145, 0.108, 0.066), 0.5 * tufts + 0.6 * blades);
  vec3 albedo = mix(soil, grass, cover);
  vec3 n = bumped(vec3(0.0, 1.0, 0.0), world, 0.016 * tufts + 0.007 * blades);
  float sun = max(dot(n, to_sun), 0.0) * sunlit(world, vec3(0.0, 1.0, 0.0));
  float hollow = 0.55 + 0.45 * blades;
  fragment = finished(kSunLight * sun * albedo * hollow * 1.3, albedo * hollow * ambient(n), world);
}

// Bark: fibres along the tube; coarse cracks only on what is thick enough to have them.
in vec3 world, normal, bark, color;
out vec4 fragment;

void main() {
  float radius = length(bark.xy);
  float pixel = length(fwidth(bark));
  float age = smoothstep(0.004, 0.02, radius);
  vec3 n = normalize(normal);
  float fine = 0.5, cracks = 0.5;
  vec3 shape = vec3(bark.xy, 0.16 * bark.z);
  fine = mix(noise(shape * 900.0), 0.5, smoothstep(0.0006, 0.0025, pixel));
  cracks = mix(noise(shape * 260.0 + 3.0 * noise(bark * 40.0)), 0.5, smoothstep(0.002, 0.009, pixel));
  float ridge = 1.0 - abs(2.0 * cracks - 1.0);
  n = bumped(n, world, age * 0.004 * cracks + 0.0005 * fine);
  vec3 albedo = color * mix(1.0, 0.55 + 0.75 * cracks, 0.85 * age) * (0.88 + 0.24 * fine);
  albedo = mix(albedo, albedo * vec3(0.85, 1.0, 0.75), 0.5 * age * noise(bark * 9.0));
  vec3 to_eye = normalize(eye - world), half_way = normalize(to_eye + to_sun);
  float sun = max(dot(n, to_sun), 0.0) * sunlit(world, normalize(normal));
  float shine = (1.0 - age) * 0.10 * pow(max(dot(n, half_way), 0.0), 24.0) * step(1e-4, sun);
  fragment = finished(kSunLight * sun * (albedo + shine), albedo * ambient(n) * (0.75 + 0.25 * ridge), world);
}

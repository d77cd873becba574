// Bark: fibres along the tube; coarse cracks only on what is thick enough to have them. Each fades out before it is
// finer than the picture.
in vec3 world, normal, bark, color;
out vec4 fragment;

void main() {
  float radius = length(bark.xy);
  float pixel = length(fwidth(bark));
  float age = smoothstep(0.004, 0.02, radius);
  vec3 n = normalize(normal);
  vec3 shape = vec3(bark.xy, 0.16 * bark.z);
  float fine = mix(noise(shape * 900.0), 0.5, smoothstep(0.0004, 0.0013, pixel));
  float plates = mix(noise(shape * 62.0 + 7.0), 0.5, smoothstep(0.005, 0.018, pixel));
  float cracks = mix(noise(shape * 190.0 + 2.5 * plates), 0.5, smoothstep(0.0030, 0.0100, pixel));
  cracks = smoothstep(0.2, 0.8, 0.6 * cracks + 0.4 * plates);
  float ridge = 1.0 - abs(2.0 * cracks - 1.0);
  n = bumped(n, world, age * 0.0045 * cracks + 0.0004 * fine);
  vec3 albedo = color * mix(1.0, 0.42 + 1.0 * cracks, 0.85 * age) * (0.88 + 0.24 * fine);
  albedo = mix(albedo, albedo * vec3(0.85, 1.0, 0.75), 0.5 * age * noise(bark * 9.0));
  vec3 to_eye = normalize(eye - world), half_way = normalize(to_eye + to_sun);
  float sun = max(dot(n, to_sun), 0.0) * sunlit(world, normalize(normal));
  float shine = (1.0 - age) * 0.10 * pow(max(dot(n, half_way), 0.0), 24.0) * step(1e-4, sun);
  fragment = finished(kSunLight * sun * (albedo + shine), albedo * ambient(n) * (0.75 + 0.25 * ridge), world);
}

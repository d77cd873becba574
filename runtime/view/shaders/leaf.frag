// A waxy blade with veins; light shines through it.
in vec3 world, normal, color;
in vec2 blade;
uniform int outline;  // LeafOutline
out vec4 fragment;

// Distance from a vein that runs from the stalk towards a lobe, in blade units.
float vein(vec2 p, vec2 towards) {
  vec2 d = normalize(towards);
  float along = clamp(dot(p, d), 0.0, length(towards));
  return length(p - along * d) + 0.012 * along;
}

void main() {
  vec2 p = vec2(abs(blade.x), blade.y);
  float nearest = outline == 0 ? min(vein(p, vec2(0.0, 0.9)), min(vein(p, vec2(0.46, 0.48)), vein(p, vec2(0.36, -0.03))))
                               : min(0.8 * p.x + 0.012 * p.y, 0.012 + abs(fract((p.y - 0.55 * p.x) * 7.0) - 0.5) / 7.0);
  float pixel = max(fwidth(blade.x), fwidth(blade.y));
  float ribs = (1.0 - smoothstep(0.008, 0.020 + pixel, nearest)) * (1.0 - smoothstep(0.02, 0.10, pixel));
  vec3 n = normalize(normal);
  bool upper = gl_FrontFacing;
  vec3 facing = upper ? n : -n;
  vec3 albedo = color * (0.86 + 0.28 * noise(blade * 6.0 + 31.0 * color.rg * 64.0));
  albedo = mix(albedo, 1.5 * albedo + vec3(0.05, 0.07, 0.02), 0.8 * ribs);
  if (!upper) albedo = mix(albedo, vec3(dot(albedo, vec3(0.333))) * vec3(1.0, 1.2, 0.75), 0.35) * 1.35;

  float facing_sun = dot(facing, to_sun), lit = sunlit(world, facing);
  float front = max(facing_sun, 0.0), through = max(-facing_sun, 0.0);
  vec3 transmitted = albedo * vec3(1.45, 1.25, 0.45) * 0.75 * through * (1.0 - 0.5 * ribs);
  vec3 to_eye = normalize(eye - world), half_way = normalize(to_eye + to_sun);
  float wax = upper ? 0.09 : 0.02;
  float shine = wax * pow(max(dot(facing, half_way), 0.0), 28.0) * step(1e-4, front);
  float rim = wax * 0.6 * pow(1.0 - max(dot(facing, to_eye), 0.0), 4.0);
  vec3 sun_part = kSunLight * lit * (albedo * front + transmitted + shine);
  vec3 ambient_part = albedo * (0.8 * ambient(facing) + 0.2 * ambient(-facing)) + rim * ambient(facing);
  fragment = finished(sun_part, ambient_part, world);
}

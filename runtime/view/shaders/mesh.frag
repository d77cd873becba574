// Obstacles: masonry or plaster, laid on whichever axis plane the surface faces most.
in vec3 world, normal;
uniform vec3 base_color;
uniform int bricks;
out vec4 fragment;

const vec2 kBrick = vec2(0.250, 0.075);  // m, with its joint
const float kJoint = 0.011;              // m

void main() {
  vec3 n = normalize(normal), weight = abs(n);
  vec2 p = weight.y > max(weight.x, weight.z) ? world.xz : weight.x > weight.z ? world.zy : world.xy;
  float pixel = max(length(dFdx(p)), length(dFdy(p)));
  float near = 1.0 - smoothstep(0.002, 0.008, pixel);  // fine grain only where it can be seen
  float grain = near > 0.0 ? mix(0.5, noise(p * 420.0), near) : 0.5;
  float stain = fractal(p * 1.7);
  vec3 albedo;
  float height;
  if (bricks == 1) {
    vec2 wobble = 0.004 * vec2(noise(p * 23.0) - 0.5, noise(p * 29.0 + 7.0) - 0.5);
    vec2 at = (p + wobble) / kBrick;
    float row = floor(at.y);
    at.x += 0.5 * mod(row, 2.0);
    vec2 cell = floor(at), inside = (at - cell) * kBrick;
    vec2 margin = min(inside, kBrick - inside) - 0.5 * kJoint;
    float edge = min(margin.x, margin.y);  // m, negative in the mortar
    float blur = 0.0015 + 0.7 * pixel;
    float solid = smoothstep(-blur, blur, edge);
    ivec3 id = ivec3(cell, 5);
    float tone = hashed(id), burn = hashed(id + ivec3(0, 0, 1));
    vec3 clay = base_color * mix(vec3(0.72, 0.66, 0.64), vec3(1.22, 1.16, 1.08), tone);
    clay = mix(clay, clay * vec3(0.62, 0.58, 0.62), step(0.86, burn));
    clay *= 0.80 + 0.25 * grain + 0.30 * (fractal(p * 31.0 + 9.0 * tone) - 0.35);
    vec3 mortar = vec3(0.46, 0.43, 0.38) * (0.75 + 0.35 * grain);
    albedo = mix(mortar, clay, solid);
    height = 0.004 * smoothstep(-0.001, 0.006 + blur, edge) + 0.0016 * grain + 0.002 * near * noise(p * 90.0);
  } else {
    float trowel = mix(0.5, noise(vec2(p.x * 14.0, p.y * 22.0)), 1.0 - smoothstep(0.01, 0.05, pixel));
    albedo = base_color * (0.93 + 0.10 * grain * trowel);
    height = 0.0025 * trowel + 0.0012 * grain;
  }
  albedo *= 0.80 + 0.40 * stain;
  float damp = smoothstep(0.5, 0.0, world.y + 0.35 * (fractal(p * 4.0) - 0.5)) * (1.0 - step(0.7, n.y));
  albedo = mix(albedo, albedo * vec3(0.62, 0.68, 0.55), 0.75 * damp);
  vec3 rough = bumped(n, world, height);
  float sun = max(dot(rough, to_sun), 0.0) * sunlit(world, n);
  fragment = finished(kSunLight * sun * albedo, albedo * ambient(rough), world);
}

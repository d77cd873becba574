// Stands before every fragment shader: noise, light and sky.

const vec3 kSunLight = vec3(3.35, 3.05, 2.6);
const vec3 kSkyLight = vec3(0.62, 0.74, 0.95);
const vec3 kGroundLight = vec3(0.29, 0.27, 0.18);

float hashed(ivec3 p) {
  uint h = uint(p.x) * 0x9E3779B1u ^ uint(p.y) * 0x85EBCA77u ^ uint(p.z) * 0xC2B2AE3Du;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 13;
  return float(h & 0xFFFFFFu) / 16777216.0;
}

// Value noise in [0, 1].
float noise(vec2 p) {
  ivec2 cell = ivec2(floor(p));
  vec2 t = p - vec2(cell);
  t = t * t * (3.0 - 2.0 * t);
  return mix(mix(hashed(ivec3(cell, 0)), hashed(ivec3(cell + ivec2(1, 0), 0)), t.x),
             mix(hashed(ivec3(cell + ivec2(0, 1), 0)), hashed(ivec3(cell + ivec2(1, 1), 0)), t.x), t.y);
}

float noise(vec3 p) {
  ivec3 cell = ivec3(floor(p));
  vec3 t = p - vec3(cell);
  t = t * t * (3.0 - 2.0 * t);
  float low = mix(mix(hashed(cell), hashed(cell + ivec3(1, 0, 0)), t.x),
                  mix(hashed(cell + ivec3(0, 1, 0)), hashed(cell + ivec3(1, 1, 0)), t.x), t.y);
  float high = mix(mix(hashed(cell + ivec3(0, 0, 1)), hashed(cell + ivec3(1, 0, 1)), t.x),
                   mix(hashed(cell + ivec3(0, 1, 1)), hashed(cell + ivec3(1, 1, 1)), t.x), t.y);
  return mix(low, high, t.z);
}

float fractal(vec2 p) { return 0.5 * noise(p) + 0.3 * noise(2.1 * p + 17.0) + 0.2 * noise(4.3 * p + 41.0); }

// The sky's haze and blue, without clouds or hills: what distant things fade into.
vec3 sky(vec3 direction) {
  float height = max(direction.y, 0.0), towards = max(dot(direction, to_sun), 0.0);
  vec3 color = mix(vec3(0.62, 0.76, 0.92), vec3(0.08, 0.26, 0.76), 1.0 - exp(-4.0 * height));
  return color + vec3(1.0, 0.80, 0.55) * (0.25 * pow(towards, 8.0) + 0.6 * pow(towards, 120.0));
}

// Highlights roll off, shadows keep their depth; then the screen's encoding.
vec3 developed(vec3 color) {
  color *= 0.62;
  color = color * (2.51 * color + 0.03) / (color * (2.43 * color + 0.59) + 0.14);  // filmic curve (Narkowicz 2015)
  return pow(clamp(color, 0.0, 1.0), vec3(1.0 / 2.2));
}

// 1 in the sun, 0 in full shadow. The point is moved off its surface by the filter's reach, against self-shadowing.
float sunlit(vec3 world, vec3 normal) {
  float slope = 1.0 - abs(dot(normal, to_sun));
  vec3 off = normal * sign(dot(normal, to_sun)) * shadow_texel * (0.6 + 1.6 * slope) * max(1.0, shadow_softness);
  vec3 p = (light_matrix * vec4(world + off, 1.0)).xyz;
  if (any(lessThan(p.xy, vec2(0.0))) || any(greaterThan(p, vec3(1.0)))) return 1.0;
  vec2 unit = shadow_softness / vec2(textureSize(shadow_map, 0));
  float sum = 0.0, middle = 0.5 * float(shadow_taps - 1), spacing = shadow_taps > 1 ? 1.0 / middle : 0.0;
  for (int i = 0; i < shadow_taps; ++i)
    for (int j = 0; j < shadow_taps; ++j)
      sum += texture(shadow_map, vec3(p.xy + (vec2(i, j) - middle) * spacing * unit, p.z));
  return sum / float(shadow_taps * shadow_taps);
}

vec3 ambient(vec3 normal) { return mix(kGroundLight, kSkyLight, 0.5 + 0.5 * normal.y); }

// Moves the normal as if the surface were raised by `height` (m) there; all derivatives are per pixel.
vec3 bumped(vec3 normal, vec3 world, float height) {
  vec3 dx = dFdx(world), dy = dFdy(world);
  vec3 rx = cross(dy, normal), ry = cross(normal, dx);
  float area = dot(dx, rx);
  vec3 gradient = sign(area) * (dFdx(height) * rx + dFdy(height) * ry);
  return normalize(abs(area) * normal - gradient);
}

// Fades into the haze and develops. The alpha channel tells the picture's last pass how much of the light is ambient:
// what ambient occlusion may take away.
vec4 finished(vec3 sun_part, vec3 ambient_part, vec3 world) {
  vec3 way = world - eye;
  float distance = length(way), haze = 1.0 - exp(-pow(distance / 160.0, 1.3));
  vec3 color = sun_part + ambient_part;
  float share = dot(ambient_part, vec3(1.0)) / max(dot(color, vec3(1.0)), 1e-5) * (1.0 - haze);
  return vec4(developed(mix(color, sky(way / distance), haze)), share);
}

// Stands before every fragment shader: noise, light and sky.

const vec3 kSunLight = vec3(3.3, 2.95, 2.45);
const vec3 kSkyLight = vec3(0.62, 0.76, 1.0);
const vec3 kGroundLight = vec3(0.30, 0.27, 0.19);

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

vec3 sky(vec3 direction) {
  float height = max(direction.y, 0.0), towards = max(dot(direction, to_sun), 0.0);
  vec3 color = mix(vec3(0.66, 0.77, 0.88), vec3(0.15, 0.33, 0.70), 1.0 - exp(-3.2 * height));
  color += vec3(1.0, 0.80, 0.55) * (0.22 * pow(towards, 8.0) + 0.5 * pow(towards, 120.0));
  return color;
}

// 1 in the sun, 0 in full shadow. The point is moved off its surface by the filter's reach, against self-shadowing.
float sunlit(vec3 world, vec3 normal) {
  float slope = 1.0 - abs(dot(normal, to_sun));
  vec3 off = normal * sign(dot(normal, to_sun)) * shadow_texel * (0.6 + 1.6 * slope) * max(1.0, shadow_softness);
  vec3 p = (light_matrix * vec4(world + off, 1.0)).xyz;
  if (any(lessThan(p.xy, vec2(0.0))) || any(greaterThan(p, vec3(1.0)))) return 1.0;
  vec2 unit = shadow_softness / vec2(textureSize(shadow_map, 0));
  float sum = 0.0;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j) sum += texture(shadow_map, vec3(p.xy + vec2(i, j) * unit, p.z));
  return sum / 9.0;
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

// Fades into the haze, compresses highlights, and encodes for the screen. The alpha channel tells the picture's last
// pass how much of the light is ambient: what ambient occlusion may take away.
vec4 finished(vec3 sun_part, vec3 ambient_part, vec3 world) {
  vec3 way = world - eye;
  float distance = length(way), haze = 1.0 - exp(-pow(distance / 90.0, 1.6));
  vec3 color = sun_part + ambient_part;
  float share = dot(ambient_part, vec3(1.0)) / max(dot(color, vec3(1.0)), 1e-5) * (1.0 - haze);
  color = mix(color, sky(way / distance), haze);
  color = color * (1.0 + color / 9.0) / (1.0 + color);  // Reinhard with white at 3
  return vec4(pow(1.22 * color, vec3(1.0 / 2.2)), share);
}

// Ambient occlusion from the depth picture: how much of a small sphere about each point lies behind the surface.
uniform sampler2D color_picture, depth_picture;
uniform vec2 slopes;       // of a pixel's ray, per clip unit
uniform vec2 depth_terms;  // of the projection: clip z = (x * -depth + y) / depth
uniform float reach;         // m
out vec4 fragment;

// Along the view, m.
float depth_at(vec2 uv) { return depth_terms.y / (depth_terms.x + 2.0 * texture(depth_picture, uv).r - 1.0); }
vec3 point_at(vec2 uv) {
  float depth = depth_at(uv);
  return vec3((2.0 * uv - 1.0) * slopes * depth, -depth);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec2 size = vec2(textureSize(depth_picture, 0)), uv = gl_FragCoord.xy / size;
  vec4 color = texelFetch(color_picture, pixel, 0);
  fragment = vec4(color.rgb, 1.0);
  if (color.a < 0.01) return;
  vec3 here = point_at(uv);
  // The flatter of the two one-sided differences: edges keep their own side's normal.
  vec2 step_x = vec2(1.0 / size.x, 0.0), step_y = vec2(0.0, 1.0 / size.y);
  vec3 right = point_at(uv + step_x) - here, left = here - point_at(uv - step_x);
  vec3 upper = point_at(uv + step_y) - here, lower = here - point_at(uv - step_y);
  vec3 normal = normalize(cross(abs(right.z) < abs(left.z) ? right : left, abs(upper.z) < abs(lower.z) ? upper : lower));

  vec2 radius = reach / (-here.z * slopes) * 0.5;  // in uv
  float turn = 6.2832 * hashed(ivec3(pixel & 3, 0)), sum = 0.0;
  const int kTaps = 14;
  for (int i = 0; i < kTaps; ++i) {
    float part = (float(i) + 0.5) / float(kTaps), angle = turn + 2.399963 * float(i);
    vec3 way = point_at(uv + sqrt(part) * radius * vec2(cos(angle), sin(angle))) - here;
    float length2 = dot(way, way), fade = max(0.0, 1.0 - length2 / (reach * reach));
    sum += fade * max(0.0, dot(way, normal) * inversesqrt(length2 + 1e-8) - 0.08);
  }
  float open = clamp(1.0 - 2.2 * sum / float(kTaps), 0.0, 1.0);
  fragment.rgb = color.rgb * mix(1.0, pow(open, 0.7), 0.25 + 0.75 * color.a);
}

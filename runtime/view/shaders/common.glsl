#version 330 core
// Stands before every shader: the frame's uniforms. Colours are linear RGB, lengths metres.

uniform mat4 view_projection;
uniform mat4 light_matrix;     // world -> shadow map, all in [0, 1]
uniform vec3 eye;
uniform vec3 to_sun;           // unit
uniform float shadow_texel;    // width of a shadow map pixel, m
uniform float shadow_softness; // half width of the filter, in shadow map pixels
uniform int shadow_taps;        // a side of the filter's grid
uniform sampler2DShadow shadow_map;

vec3 unpacked(vec4 color) { return color.rgb * color.rgb; }

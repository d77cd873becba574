in vec4 color;
out vec4 fragment;

void main() { fragment = vec4(sqrt(color.rgb), color.a); }

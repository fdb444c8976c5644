#version 330 core
// Her outline, one colour: drawn by backs of triangles, most of which she hides.
uniform vec3 line;
out vec4 colour;
void main() { colour = vec4(line, 1.0); }

#version 330 core
// Her outline, one colour: drawn by backs of triangles, most of which she hides.
uniform vec3 line;
in vec3 terms;
out vec4 colour;
void main() {
    if (terms.y > 0.999) discard;  // skin in a fold has turned a triangle over: no edge
    colour = vec4(line, 1.0);
}

#version 330 core
// Puts the dancer, drawn on nothing, on the picture: her alpha is how much of a pixel she covers.
uniform sampler2D drawn;      // one texel a pixel, or two by two, whose mean is what lies between them
uniform vec2 size;            // of the picture, pixels
out vec4 colour;
void main() { colour = texture(drawn, gl_FragCoord.xy / size); }

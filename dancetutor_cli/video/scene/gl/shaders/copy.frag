#version 330 core
// Puts the dancer, drawn on nothing, on the picture: her alpha is how much of a pixel she covers.
uniform sampler2D picture;
out vec4 colour;
void main() { colour = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }

#version 300 es
// The shadow map has depth only.
precision highp float;
void main() {}

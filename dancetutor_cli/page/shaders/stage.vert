#version 300 es
// A corner of the stage: floor, pad or wall.
precision highp float;
layout(location = 0) in vec3 corner;
layout(location = 1) in vec2 place;   // on a wall: across -1..1, up 0..1
layout(location = 2) in float sort;   // video.stage.Kind
uniform mat4 camera;
out vec3 world;
out vec2 wall;
flat out int kind;

void main() {
    world = corner;
    wall = place;
    kind = int(sort + 0.5);
    gl_Position = camera * vec4(corner, 1.0);
}

#version 330 core
// A vertex of the dancer: skinning, then the camera, the outline or the light. Lighting terms as in cpu/shade.py.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 hull;
layout(location = 3) in vec2 texcoord;
layout(location = 4) in vec4 joints;
layout(location = 5) in vec4 weights;
layout(location = 6) in float above;    // metres nearer to the light at which her own shadow is asked for

layout(std140) uniform Joints { vec4 rows[768]; };  // three rows a joint
uniform mat4 camera;         // world to clip space
uniform mat4 light;          // world to clip space of the shadow map
uniform vec3 eye;
uniform vec3 sun;
uniform vec2 pixels;         // half the picture's size in pixels
uniform float outline;       // width in pixels; 0: the dancer herself
uniform float focal;         // pixels
uniform vec2 off_surface;
uniform float to_map;         // 1: draw the shadow map

out vec2 uv;
out vec3 terms;              // to light, facing (of the outline 1: looks at the viewer), up
out vec3 place_in_light;

vec3 by_rows(vec4 a, vec4 b, vec4 c, vec4 p) { return vec3(dot(a, p), dot(b, p), dot(c, p)); }

void main() {
    vec4 a = vec4(0.0), b = vec4(0.0), c = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        int row = 3 * int(joints[i] + 0.5);
        a += weights[i] * rows[row];
        b += weights[i] * rows[row + 1];
        c += weights[i] * rows[row + 2];
    }
    vec3 world = by_rows(a, b, c, vec4(position, 1.0));
    vec3 n = normalize(by_rows(a, b, c, vec4(normal, 0.0)));
    uv = texcoord;
    terms = vec3(dot(n, sun), dot(n, normalize(eye - world)), n.y);
    place_in_light = (light * vec4(world + n * off_surface.x + sun * (off_surface.y + above), 1.0)).xyz * 0.5 + 0.5;
    if (to_map > 0.0) {
        gl_Position = light * vec4(world, 1.0);
        return;
    }
    gl_Position = camera * vec4(world, 1.0);
    if (outline > 0.0) {
        vec3 h = normalize(by_rows(a, b, c, vec4(hull, 0.0)));
        terms.y = step(0.35, dot(h, normalize(eye - world)));  // as _FOLD in cpu/raster.py
        vec4 along = camera * vec4(h, 0.0);
        float w = gl_Position.w;
        // The normal on the picture, as a part of the length it has when it points sideways.
        vec2 d = (along.xy - gl_Position.xy / w * along.w) * pixels / focal;
        vec2 shift = d * (outline / (length(d) + 0.12));
        gl_Position.xy += shift / pixels * w;
        // A centimetre away from the camera, without moving on the picture.
        gl_Position = vec4(gl_Position.xy * ((w + 0.01) / w), gl_Position.z + 0.01, w + 0.01);
    }
}

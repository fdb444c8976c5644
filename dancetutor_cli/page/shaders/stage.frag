#version 300 es
// The stage in the films' colours (film/scene/cpu/stage_colours.py), with what falls on it (film/scene/cpu/floor.py).
precision highp float;
precision highp int;
precision highp sampler2DShadow;
in vec3 world;
in vec2 wall;
flat in int kind;

uniform vec3 palette[12];     // in the order of film/scene/cpu/stage_colours.py COLOURS
uniform vec3 size;            // tile, pool, panel
uniform vec4 pad;             // its middle (x, z) and half its size
uniform vec2 corner_of_tiles;
uniform ivec2 tiles;
uniform highp sampler2D tile_of;    // for each tile: panel or -1, arrow (x, z)
uniform highp sampler2D lights;     // for each panel: colour 0..1, how lit
uniform sampler2DShadow shadow;
uniform mat4 light;
uniform float dark;
uniform float spread;
uniform vec2 middles[2];      // where those stand who cast the shadow
uniform vec3 fade;            // metres from there over which the shadow grows light, and what is left of it
uniform vec3 contact;
uniform float radius;
uniform vec4 foot[4];         // heel x, z, toe x, z
uniform vec4 foot_state[4];   // ground, nearness to it (< 0: no foot), strength of the mark, how much it presses a panel
uniform vec3 foot_colour[4];
uniform float beside;         // of its mark that a foot keeps beside the panel that it presses
uniform vec4 sole[2];         // where the next step's feet will stand, left and right: heel x, z, toe x, z
uniform vec2 sole_ground;     // height of the ground there; none far below

out vec4 colour;

float line(float x, float tile, float half_width, float footprint) {
    float d = abs(x / tile - floor(x / tile + 0.5)) * tile;
    float cover = clamp((half_width - d) / footprint + 0.5, 0.0, 1.0);
    return cover * min(1.0, 2.0 * half_width / footprint);
}

vec3 floor_colour(vec2 at, float footprint) {
    vec2 d = max(abs(at - pad.xy) - pad.zw, 0.0);
    float away = dot(d, d) / (size.y * size.y);
    float lit = 1.0 / (1.0 + away);
    lit *= lit;
    float lines = max(line(at.x - pad.x - pad.z, size.x, 0.007, footprint),
                      line(at.y - pad.y - pad.w, size.x, 0.007, footprint));
    return mix(mix(palette[1], palette[0], lit), palette[2], lines * lit);
}

float arrow_distance(float a, float b) {
    b = abs(b);
    float head = max(0.02 - a, (a + 1.12 * b - 0.36) * 0.666);
    float shaft = max(b - 0.105, max(-0.33 - a, a - 0.05));
    return min(head, shaft);
}

vec3 pad_colour(vec2 at, float footprint, out int column, out float glow, out float white) {
    vec2 place = vec2(corner_of_tiles.x - at.x, at.y - corner_of_tiles.y) / size.z;
    ivec2 tile = clamp(ivec2(floor(place)), ivec2(0), tiles - 1);
    vec2 l = vec2(-(place.x - float(tile.x) - 0.5), place.y - float(tile.y) - 0.5);
    float soft = max(footprint / size.z, 1e-4);
    float edge = max(abs(l.x), abs(l.y));
    float inside = clamp((0.478 - edge) / soft + 0.5, 0.0, 1.0);
    float border = clamp((edge - 0.425) / soft + 0.5, 0.0, 1.0) * inside;
    vec3 info = texelFetch(tile_of, tile, 0).xyz;
    column = int(floor(info.x + 0.5));
    glow = 0.0;
    white = 0.0;
    if (column < 0) {
        return mix(palette[10], palette[9], inside);
    }
    vec2 arrow = info.yz;
    float d = dot(arrow, arrow) > 0.0 ? arrow_distance(dot(l, arrow), l.x * arrow.y - l.y * arrow.x) : edge - 0.24;
    float drawn = clamp(-d / soft + 0.5, 0.0, 1.0);
    vec3 base = mix(palette[10], palette[8], inside) * (1.0 + 0.10 * (l.y + 0.5));
    glow = inside * max(0.72, max(border, drawn));
    white = max(0.62 * drawn, 0.35 * border);
    return mix(base, palette[11], max(drawn, 0.30 * border));
}

vec3 wall_colour(float u, float v) {
    float core = u / (0.03 + 0.5 * v), beam = u / (0.16 + 1.1 * v), near = v / 0.035;
    core = 1.0 / (1.0 + core * core);
    beam = 1.0 / (1.0 + beam * beam);
    float lamp = smoothstep(0.012, 0.03, v) / (1.0 + near * near);
    float high = smoothstep(0.012, 0.06, v) * (1.0 - smoothstep(0.05, 0.5, v));
    return mix(palette[3], palette[4], smoothstep(0.0, 0.6, v)) + palette[5] * (0.9 * core * core * lamp + 0.34 * beam * high);
}

float shadowed(vec3 at) {
    vec3 p = (light * vec4(at, 1.0)).xyz * 0.5 + 0.5;
    if (any(lessThan(p.xy, vec2(0.0))) || any(greaterThan(p.xy, vec2(1.0)))) {
        return 0.0;
    }
    float sum = 4.0 * texture(shadow, vec3(p.xy, 0.999));
    for (int i = 0; i < 4; ++i) {
        vec2 away = 0.75 * spread * vec2(float((i & 1) * 2 - 1), float((i & 2) - 1));
        sum += 3.0 * texture(shadow, vec3(p.xy + away, 0.999));
    }
    return 1.0 - sum / 16.0;
}

float from_foot(vec2 p, vec4 f) {
    vec2 way = f.zw - f.xy;
    float along = clamp(dot(p - f.xy, way) / max(dot(way, way), 1e-9), 0.0, 1.0);
    return length(p - f.xy - along * way);
}

// Metres from the edge of a sole of a foot of size 1 from above, negative inside: the shape of overlay/diagram.py.
const float SOLE = 0.305;  // metres of that size

float from_sole(vec2 p, vec4 f, float mirror) {
    vec2 ahead = normalize(f.zw - f.xy);
    vec2 q = (p - 0.5 * (f.xy + f.zw)) / SOLE;
    float y = dot(q, ahead), x = dot(q, vec2(-ahead.y, ahead.x));
    float along = clamp(y / 0.3, -1.0, 1.0);
    float bend = 0.02 * mirror * (along * along - 0.3);
    return SOLE * (length(vec2(x - bend, max(abs(y) - 0.26, 0.0))) - 0.15 - 0.022 * along);
}

vec3 with_soles(vec3 value, float footprint) {
    for (int k = 0; k < 2; ++k) {
        if (abs(world.y - sole_ground[k]) > 0.03) {
            continue;
        }
        float d = from_sole(world.xz, sole[k], k == 0 ? 1.0 : -1.0);
        value = mix(value, vec3(0.03, 0.035, 0.06), 0.6 * clamp(0.5 - (d - 0.012 * SOLE) / footprint, 0.0, 1.0));
        value = mix(value, vec3(1.0), 0.7 * clamp(0.5 - (d + 0.005 * SOLE) / footprint, 0.0, 1.0));
        value = mix(value, foot_colour[k], 0.8 * clamp(0.5 - (d + 0.03 * SOLE) / footprint, 0.0, 1.0));
    }
    return value;
}

void main() {
    if (kind == 2) {
        colour = vec4(palette[7], 1.0);
        return;
    }
    if (kind == 3) {
        colour = vec4(min(wall_colour(wall.x, wall.y), 1.0), 1.0);
        return;
    }
    vec3 across = dFdx(world), along = dFdy(world);
    float footprint = max(sqrt(max(dot(across, across), dot(along, along))), 1e-4);
    int column = -1;
    float glow = 0.0, white = 0.0;
    vec3 value = kind == 1 ? pad_colour(world.xz, footprint, column, glow, white) : floor_colour(world.xz, footprint);
    float away = min(distance(world.xz, middles[0]), distance(world.xz, middles[1]));
    float left = 1.0 - (1.0 - fade.z) * smoothstep(fade.x, fade.y, away);
    float keep = dark > 0.0 ? 1.0 - dark * left * shadowed(world) : 1.0;
    vec4 lit = column >= 0 ? texelFetch(lights, ivec2(column, 0), 0) : vec4(0.0);
    float ring = 0.0;
    vec3 ring_colour = vec3(0.0);
    for (int f = 0; f < 4; ++f) {
        float near = foot_state[f].y;
        if (near < 0.0 || abs(world.y - foot_state[f].x) > 0.03) {
            continue;
        }
        float d = from_foot(world.xz, foot[f]) - radius;
        keep *= 1.0 - contact.x * near * (1.0 - smoothstep(0.0, contact.y * (1.6 - 0.6 * near), d));
        float planted = smoothstep(0.88, 0.95, near);
        float band = clamp((0.0040 + 0.0060 * planted - abs(d - (0.0220 - 0.0090 * planted))) / footprint + 0.5, 0.0, 1.0);
        band *= foot_state[f].z;
        float pressed = foot_state[f].w;
        float on = column >= 0 && distance(lit.rgb, foot_colour[f]) < 0.004 ? lit.a * pressed : 0.0;
        band *= on > 0.0 ? 1.0 : 1.0 - (1.0 - beside) * pressed;
        if (band > ring) {
            ring = band;
            ring_colour = mix(foot_colour[f], vec3(1.0), on);
        }
    }
    value *= keep;
    float shine = glow * lit.a * contact.z;
    value = mix(value, lit.rgb * (0.80 + 0.20 * keep), shine);
    value = mix(value, vec3(1.0), white * lit.a * contact.z * step(1e-6, shine));
    colour = vec4(mix(with_soles(value, footprint), ring_colour, ring), 1.0);
}

#version 330 core
// Shadow, contact shadows, lit panels and foot marks on the standing picture, as in cpu/floor.py.
uniform sampler2D standing;   // colour 0..1, and how much the pixel takes shadows
uniform sampler2D ground;     // world x, y, z, and metres in a pixel
uniform sampler2D panels;     // panel or -1, glow, whiteness
uniform sampler2DShadow shadow;
uniform sampler2D lights;     // a texel for each panel: colour 0..1, how lit
uniform int shift;
uniform mat4 light;
uniform float dark;
uniform float spread;         // distance of the shadow's taps, part of the map
uniform vec4 within;          // the part of the map beyond which there is no shadow
uniform vec2 middles[2];      // where those stand who cast the shadow
uniform vec3 fade;            // metres from there over which the shadow grows light, and what is left of it
uniform vec3 contact;         // darkness, softness, strength of lit panels
uniform float radius;
uniform int feet;             // how many can reach what is drawn
uniform vec4 foot[4];         // heel x, z, toe x, z
uniform vec4 foot_state[4];   // ground, nearness to it (< 0: no foot), strength of the mark, how much it presses a panel
uniform float beside;         // of its mark that it keeps beside that panel
uniform vec3 foot_colour[4];

out vec4 colour;

float shadowed(vec3 at) {
    vec3 p = (light * vec4(at, 1.0)).xyz * 0.5 + 0.5;
    if (any(lessThan(p.xy, max(within.xy - 2.0 * spread, 0.0))) || any(greaterThan(p.xy, min(within.zw + 2.0 * spread, 1.0)))) {
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
    vec2 line = f.zw - f.xy;
    float along = clamp(dot(p - f.xy, line) / max(dot(line, line), 1e-9), 0.0, 1.0);
    return length(p - f.xy - along * line);
}

float dither(ivec2 p) {
    int r = p.y & 3, c = p.x & 3;
    int rank = ((r ^ c) & 1) * 8 + (r & 1) * 4 + (((r ^ c) >> 1) & 1) * 2 + ((r >> 1) & 1);
    return (float(rank) + 0.5) / 16.0;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) + ivec2(shift, 0);
    vec4 base = texelFetch(standing, pixel, 0);
    if (base.a <= 0.0) {
        discard;
    }
    vec4 at = texelFetch(ground, pixel, 0);
    vec4 info = texelFetch(panels, pixel, 0);
    float away = min(distance(at.xz, middles[0]), distance(at.xz, middles[1]));
    float left = 1.0 - (1.0 - fade.z) * smoothstep(fade.x, fade.y, away);
    float keep = dark > 0.0 ? 1.0 - dark * left * shadowed(at.xyz) : 1.0;
    vec4 lit = info.x >= 0.0 ? texelFetch(lights, ivec2(int(info.x + 0.5), 0), 0) : vec4(0.0);
    float ring = 0.0;
    vec3 ring_colour = vec3(0.0);
    for (int f = 0; f < feet; ++f) {
        float near = foot_state[f].y;
        if (near < 0.0 || abs(at.y - foot_state[f].x) > 0.03) {
            continue;
        }
        float d = from_foot(at.xz, foot[f]) - radius;
        float reach = contact.y * (1.6 - 0.6 * near);
        keep *= 1.0 - contact.x * near * (1.0 - smoothstep(0.0, reach, d));
        float planted = smoothstep(0.88, 0.95, near);
        float band = clamp((0.0040 + 0.0060 * planted - abs(d - (0.0220 - 0.0090 * planted))) / at.w + 0.5, 0.0, 1.0);
        band *= foot_state[f].z;
        float pressed = foot_state[f].w;
        float light = info.x >= 0.0 && distance(lit.rgb, foot_colour[f]) < 0.004 ? lit.a * pressed : 0.0;
        band *= light > 0.0 ? 1.0 : 1.0 - (1.0 - beside) * pressed;
        if (band > ring) {
            ring = band;
            ring_colour = mix(foot_colour[f], vec3(1.0), light);
        }
    }
    float shine = info.y * lit.a * contact.z;
    if (keep >= 1.0 && shine <= 0.0 && ring <= 0.0) {
        discard;
    }
    keep = 1.0 - (1.0 - keep) * base.a;
    vec3 value = base.rgb * keep;
    if (shine > 0.0) {
        value = mix(value, lit.rgb * (0.80 + 0.20 * keep), shine);
        value = mix(value, vec3(1.0), info.z * lit.a * contact.z);
    }
    value = mix(value, ring_colour, ring * base.a);
    // The 8-bit target rounds to the nearest: dither less a half gives the same steps as the software renderer.
    colour = vec4(value + (dither(pixel) - 0.5) / 255.0, 1.0);
}

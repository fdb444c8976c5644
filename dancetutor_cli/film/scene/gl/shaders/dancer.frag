#version 330 core
// Toon light, self shadow and rim, as in cpu/shade.py.
in vec2 uv;
in vec3 terms;
in vec3 place_in_light;

uniform sampler2D skin;
uniform vec3 tint;
uniform sampler2DShadow shadow;
uniform vec3 outline_colour;
uniform float outline;
uniform float has_shadow;
uniform vec3 bands;          // edge of half light, edge of full light, half the width of both
uniform vec3 levels;
uniform vec2 rim;            // strength, where it begins
uniform vec3 shade;
uniform float least;         // half light that this surface has at least

out vec4 colour;

float sunlit() {
    if (has_shadow <= 0.0 || any(lessThan(place_in_light, vec3(0.0))) || any(greaterThan(place_in_light, vec3(1.0)))) {
        return 1.0;
    }
    return texture(shadow, place_in_light);
}

void main() {
    if (outline > 0.0) {
        colour = vec4(outline_colour, 1.0);
        return;
    }
    float sun = terms.x > bands.x - bands.z ? sunlit() : 1.0;
    float half_light = smoothstep(bands.x - bands.z, bands.x + bands.z, terms.x) * (0.5 + 0.5 * sun);
    half_light = max(half_light, least);
    float full_light = smoothstep(bands.y - bands.z, bands.y + bands.z, terms.x) * sun;
    float level = levels.x + (levels.y - levels.x) * half_light + (levels.z - levels.y) * full_light;
    level *= 0.95 + 0.05 * terms.z;
    float edge = rim.x * smoothstep(rim.y, rim.y + 0.2, 1.0 - terms.y) * (0.6 + 0.4 * terms.z);
    vec3 lit = texture(skin, uv).rgb * tint * level * mix(shade, vec3(1.0), half_light);
    colour = vec4(min(lit + (1.0 - lit) * edge, 1.0), 1.0);
}

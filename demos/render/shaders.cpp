#include "shaders.h"

namespace render::shaders {

// Sky, light and fog, shared by everything that is lit. All colours are linear light; the framebuffer encodes
// sRGB.
const char* const kLight = R"(
uniform vec3 sun, eye;
uniform float haze;  // [1/m]
uniform mat4 sun_clip, zenith_clip;
uniform sampler2DShadow sun_map, zenith_map;
uniform sampler2D sun_depths, around;  // the sun's map as numbers; see around_visible
uniform vec2 texel;                    // size of a shadow map texel in the world [m]: sun, zenith
uniform vec3 sun_right, sun_up;        // axes of the sun's map
uniform vec2 sun_scale;                // of it along them [1/m]
uniform float sun_depth, sun_tangent;  // depth of its box [m]; of the sun's half angle
uniform float around_reach;            // [m]
const vec3 kHorizon = vec3(0.80, 0.98, 1.18), kZenith = vec3(0.07, 0.25, 0.66);
const vec3 kSunLight = vec3(3.30, 3.00, 2.55), kSkyLight = vec3(0.55, 0.70, 0.95);
const vec3 kGroundLight = vec3(0.30, 0.28, 0.25), kFloor = vec3(0.42, 0.44, 0.46);
vec3 sky_colour(vec3 d) {
    // Below the horizon is what a ground without end would be.
    vec3 c = d.y > 0.0 ? mix(kHorizon, kZenith, sqrt(d.y)) : mix(kHorizon, kFloor, smoothstep(0.0, 0.3, -d.y));
    float towards = max(dot(d, sun), 0.0);
    return c + vec3(1.0, 0.85, 0.6) * (0.25 * pow(towards, 24.0) + 4.0 * smoothstep(0.9995, 0.9999, towards));
}
vec3 film(vec3 c) {  // filmic curve: a toe for contrast, a shoulder for highlights
    c *= 0.60;
    return clamp(c * (2.4 * c + 0.05) / (c * (2.3 * c + 0.62) + 0.13), 0.0, 1.0);
}
vec3 fogged(vec3 c, vec3 p) {
    vec3 d = p - eye;
    float r = length(d);
    float f = 1.0 - exp(-pow(r * haze, 2.0));
    return mix(c, kHorizon, f);
}
// Turns a pattern from pixel to pixel, so that its gaps do not line up (Jimenez 2014).
mat2 turn_of_pixel() {
    float a = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    return mat2(cos(a), sin(a), -sin(a), cos(a));
}
// Points that fill a unit disc evenly, from its middle outwards by the golden angle: i at sqrt((i + 0.5) / 16).
const vec2 kDisc[16] = vec2[16](
    vec2(0.177, 0.000), vec2(-0.226, 0.207), vec2(0.035, -0.394), vec2(0.285, 0.371),
    vec2(-0.522, -0.092), vec2(0.495, -0.315), vec2(-0.165, 0.616), vec2(-0.316, -0.608),
    vec2(0.685, 0.250), vec2(-0.712, 0.294), vec2(0.343, -0.734), vec2(0.254, 0.809),
    vec2(-0.765, -0.443), vec2(0.897, -0.197), vec2(-0.548, 0.779), vec2(-0.126, -0.976));
// Share of the sun's disc that a point sees. What is z metres nearer to the sun blurs the shadow by z times the tangent
// of the disc's half angle: z is the mean over what is within the widest such disc (Fernando 2005).
float sun_visible(vec3 p, vec3 n, float facing) {
    const int kSearched = 12, kFiltered = 16;
    const float kWhole = 1.1547;  // brings the first twelve points to the unit disc
    // Along the normal by about a texel: no acne, no gap.
    vec3 q = p + n * texel.x * (1.0 + sqrt(max(1.0 - facing * facing, 0.0)));
    vec3 s = (sun_clip * vec4(q, 1.0)).xyz * 0.5 + 0.5;
    if (any(lessThan(s, vec3(0.0))) || any(greaterThan(s.xy, vec2(1.0)))) return 1.0;
    // The plane that the point lies in goes on under the filter: its depth a metre across.
    vec2 slope = vec2(dot(n, sun_right), dot(n, sun_up)) / (max(facing, 0.1) * sun_depth);
    mat2 turn = turn_of_pixel();
    float widest = s.z * sun_depth * sun_tangent, near = 0.0, blockers = 0.0;
    for (int i = 0; i < kSearched; ++i) {
        vec2 at = turn * kDisc[i] * (kWhole * widest);
        float z = texture(sun_depths, s.xy + at * sun_scale).r;
        if (z < min(s.z + dot(slope, at), 1.0)) {  // 1: nothing is there
            near += z;
            blockers += 1.0;
        }
    }
    if (blockers == 0.0) return 1.0;
    float radius = max((s.z - near / blockers) * sun_depth * sun_tangent, 1.5 * texel.x);
    float lit = 0.0;
    for (int i = 0; i < kFiltered; ++i) {
        vec2 at = turn * kDisc[i] * radius;
        lit += texture(sun_map, vec3(s.xy + at * sun_scale, s.z + dot(slope, at) - 0.0001));
    }
    return lit / float(kFiltered);
}
// Share of the light from around that comes to a place between things near it: of the picture of it, which has a texel
// for four pixels, those texels that are as far away.
float around_visible() {
    vec2 at = gl_FragCoord.xy * 0.5 - 0.5;
    ivec2 first = ivec2(floor(at)), last = textureSize(around, 0) - 1;
    vec2 f = at - vec2(first);
    float depth = 1.0 / gl_FragCoord.w, sum = 0.0, all = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 o = ivec2(i & 1, i >> 1);
        vec2 t = texelFetch(around, clamp(first + o, ivec2(0), last), 0).rg;
        vec2 w = mix(1.0 - f, f, vec2(o));
        float weight = w.x * w.y * max(1.0 - abs(t.g - depth) / around_reach, 0.0) + 1e-5;
        sum += weight * t.r;
        all += weight;
    }
    return sum / all;
}
// Share of the sky above that a point sees: a second depth map from the zenith, widely filtered.
float sky_visible(vec3 p, vec3 n) {
    vec4 c = zenith_clip * vec4(p + n * 0.12 + vec3(0.0, 0.03, 0.0), 1.0);
    vec3 s = c.xyz * 0.5 + 0.5;
    if (any(lessThan(s, vec3(0.0))) || any(greaterThan(s.xy, vec2(1.0)))) return 1.0;
    vec2 t = 1.0 / (texel.y * vec2(textureSize(zenith_map, 0)));  // of one metre
    const vec2 tap[8] = vec2[8](vec2(0.18, 0.05), vec2(-0.12, 0.22), vec2(-0.20, -0.18), vec2(0.10, -0.30),
                                vec2(0.55, 0.30), vec2(-0.45, 0.50), vec2(-0.55, -0.42), vec2(0.48, -0.52));
    float open = 0.0;
    for (int i = 0; i < 8; ++i) open += texture(zenith_map, vec3(s.xy + tap[i] * t, s.z));
    return mix(0.35, 1.0, open / 8.0);
}
vec3 lit_colour(vec3 albedo, vec3 p, vec3 n, float gloss) {
    float facing = max(dot(n, sun), 0.0);
    float direct = facing > 0.0 ? facing * sun_visible(p, n, facing) : 0.0;
    float open = sky_visible(p, n) * around_visible();
    vec3 ambient = mix(kGroundLight, kSkyLight, n.y * 0.5 + 0.5) * open;
    vec3 view = normalize(eye - p), middle = normalize(view + sun);
    float fresnel = pow(1.0 - max(dot(n, view), 0.0), 5.0);
    vec3 shine = kSunLight * (direct * gloss * 0.55 * pow(max(dot(n, middle), 0.0), 48.0));
    shine += sky_colour(reflect(-view, n)) * (gloss * open * (0.06 + 0.5 * fresnel));
    return film(fogged(albedo * (ambient * 0.62 + kSunLight * direct * 0.55) + shine, p));
}
)";

const char* const kSolidVertex = R"(
layout(location = 0) in vec3 vertex;
layout(location = 1) in vec3 vertex_normal;
layout(location = 2) in vec3 position;
layout(location = 3) in vec3 scale;
layout(location = 4) in vec4 rotation;
layout(location = 5) in vec4 colour_gloss;
uniform mat4 clip_from_world;
uniform vec3 viewer;
uniform float pull;  // [m] by which depth is moved towards the viewer
out vec3 world, local, local_normal, half_size;
out vec4 paint;  // of surfaces it differs from corner to corner
flat out vec4 turn;
vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
void main() {
    local = vertex * scale;
    half_size = scale;
    world = position + turned(rotation, local);
    local_normal = vertex_normal / scale;
    paint = colour_gloss;
    turn = rotation;
    gl_Position = clip_from_world * vec4(world, 1.0);
    if (pull > 0.0) {
        vec4 near = clip_from_world * vec4(world + normalize(viewer - world) * pull, 1.0);
        gl_Position.z = near.z / near.w * gl_Position.w;
    }
}
)";

const char* const kSolidFragment = R"(
in vec3 world, local, local_normal, half_size;
in vec4 paint;
flat in vec4 turn;
uniform int bevelled, unlit;
uniform float cover;
out vec4 colour;
vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
void main() {
    if (unlit != 0) {
        colour = vec4(fogged(paint.rgb, world), 1.0);
        return;
    }
    vec3 n = normalize(local_normal);
    vec3 albedo = paint.rgb;
    if (bevelled != 0) {
        // A box catches light on its edges: within a small rim of a face the normal leans outwards and the
        // paint is worn a little lighter. Rims below a pixel fade out.
        float rim = clamp(0.10 * min(half_size.x, min(half_size.y, half_size.z)), 0.004, 0.04);
        vec3 lean = smoothstep(vec3(-rim), vec3(0.0), abs(local) - half_size) * sign(local) * (1.0 - step(0.5, abs(n)));
        float shown = clamp(rim / max(length(fwidth(local)), 1e-6), 0.0, 1.0);
        n = normalize(n + lean * (0.8 * shown));
        albedo *= 1.0 + 0.12 * shown * min(length(lean), 1.0);
    }
    colour = vec4(lit_colour(albedo, world, turned(turn, n), paint.a), cover);
}
)";

const char* const kDepthFragment = R"(
void main() {}
)";

const char* const kGroundVertex = R"(
uniform mat4 clip_from_world;
uniform vec3 eye;
uniform float height, half_width;
out vec3 world;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    world = vec3(eye.x + corner.x * half_width, height, eye.z + corner.y * half_width);
    gl_Position = clip_from_world * vec4(world, 1.0);
}
)";

const char* const kGroundFragment = R"(
in vec3 world;
out vec4 colour;
// Share of a pixel covered by lines of the given half width [m] every period [m].
float lines(vec2 p, float period, float half_width) {
    vec2 w = max(fwidth(p), 1e-6);
    vec2 d = abs(fract(p / period + 0.5) - 0.5) * period;
    vec2 cover = clamp((half_width + 0.5 * w - d) / w, 0.0, 1.0) * clamp(2.0 * half_width / w, 0.0, 1.0);
    vec2 full = clamp((period * 0.5 - w) / (period * 0.25), 0.0, 1.0);
    return max(cover.x * full.x, cover.y * full.y);
}
// Smooth noise in [0, 1] of cells of unit size.
float grain(vec2 p) {
    ivec2 cell = ivec2(floor(p));
    vec2 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    float corner[4];
    for (int i = 0; i < 4; ++i) {
        uvec2 q = uvec2(cell + ivec2(i & 1, i >> 1));
        uint h = q.x * 1597334677u ^ q.y * 3812015801u;
        h = (h ^ (h >> 15u)) * 2246822519u;
        corner[i] = float((h ^ (h >> 13u)) & 65535u) / 65535.0;
    }
    return mix(mix(corner[0], corner[1], f.x), mix(corner[2], corner[3], f.x), f.y);
}
// Concrete: octaves of noise that fade out below a pixel.
float concrete(vec2 p) {
    float pixel = max(length(fwidth(p)), 1e-6), sum = 0.0, share = 0.5;
    for (float size = 1.6; size > 0.01; size *= 0.42) {
        sum += share * (grain(p / size) - 0.5) * clamp(size / pixel - 1.0, 0.0, 1.0);
        share *= 0.72;
    }
    return sum;
}
void main() {
    // Distances count in those at which a camera usually is.
    float r = length(world - eye) * haze / 0.009;
    // Slabs of a metre in two tones.
    vec2 slab = floor(world.xz);
    float odd = mod(slab.x + slab.y, 2.0) * exp(-r / 45.0);
    vec3 albedo = mix(vec3(0.25, 0.265, 0.285), vec3(0.195, 0.21, 0.235), odd);
    albedo *= 1.0 + 0.42 * concrete(world.xz);
    float minor = lines(world.xz, 1.0, 0.008) * exp(-r / 22.0);
    float major = lines(world.xz, 10.0, 0.03) * exp(-r / 70.0);
    float fine = lines(world.xz, 0.1, 0.0008) * exp(-r / 2.0);
    albedo = mix(albedo, vec3(0.11, 0.12, 0.135), max(0.75 * minor, 0.4 * fine));
    albedo = mix(albedo, vec3(0.52, 0.56, 0.62), 0.75 * major);
    colour = vec4(lit_colour(albedo, world, vec3(0.0, 1.0, 0.0), 0.10), 1.0);
}
)";

const char* const kSkyVertex = R"(
uniform vec3 right, up, back;  // right and up scaled by the tangents of half the field of view
out vec3 direction;
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    direction = right * corner.x + up * corner.y - back;
    gl_Position = vec4(corner, 1.0, 1.0);
}
)";

const char* const kSkyFragment = R"(
in vec3 direction;
out vec4 colour;
void main() { colour = vec4(film(sky_colour(normalize(direction))), 1.0); }
)";

const char* const kScreenVertex = R"(
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

// After the obscurance of McGuire et al. 2011: of points on a spiral about each texel, those above its plane and near.
// The spiral is turned by texel in squares of four by four, over which kAroundBlur takes the mean.
const char* const kAroundFragment = R"(
uniform sampler2D depths;
uniform vec2 planes, tangents;  // near and far [m]; of half the field of view
uniform float around_reach;     // [m]
out vec2 result;                // share of light, distance along the view [m]
// By the golden angle, evenly outwards.
const vec2 kSpiral[8] = vec2[8](
    vec2(0.062, 0.000), vec2(-0.138, 0.127), vec2(0.027, -0.311), vec2(0.266, 0.347),
    vec2(-0.554, -0.098), vec2(0.580, -0.369), vec2(-0.211, 0.785), vec2(-0.432, -0.832));
vec3 place(ivec2 texel) {
    ivec2 size = textureSize(depths, 0);
    float d = 2.0 * texelFetch(depths, clamp(texel, ivec2(0), size - 1), 0).r - 1.0;
    float z = 2.0 * planes.x * planes.y / (planes.x + planes.y - d * (planes.y - planes.x));
    return vec3(((vec2(texel) + 0.5) / vec2(size) * 2.0 - 1.0) * tangents * z, z);
}
// Along a surface: the nearer one of the two neighbours.
vec3 along(vec3 before, vec3 here, vec3 after) {
    return abs(before.z - here.z) < abs(after.z - here.z) ? here - before : after - here;
}
void main() {
    const int kPoints = 8;
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 p = place(at);
    vec3 n = normalize(cross(along(place(at - ivec2(0, 1)), p, place(at + ivec2(0, 1))),
                             along(place(at - ivec2(1, 0)), p, place(at + ivec2(1, 0)))));
    float texels = around_reach / p.z * float(textureSize(depths, 0).y) / (2.0 * tangents.y);
    if (p.z > 0.5 * planes.y || texels < 1.0) {
        result = vec2(1.0, p.z);
        return;
    }
    float a = 6.2831853 * float((at.x & 3) * 4 + ((at.y + (at.x & 3) * 2) & 3)) / 16.0, sum = 0.0;
    mat2 turn = texels * mat2(cos(a), sin(a), -sin(a), cos(a));
    for (int i = 0; i < kPoints; ++i) {
        vec3 v = place(at + ivec2(round(turn * kSpiral[i]))) - p;
        float square = dot(v, v), above = dot(v, n) - 0.002 * p.z;
        sum += max(1.0 - square / (around_reach * around_reach), 0.0) * max(above, 0.0) * inversesqrt(square + 1e-12);
    }
    result = vec2(max(1.0 - 2.2 * sum / float(kPoints), 0.0), p.z);
}
)";

const char* const kAroundBlur = R"(
uniform sampler2D around;
uniform float around_reach;
out vec2 result;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(around, 0) - 1;
    float depth = texelFetch(around, at, 0).g, sum = 0.0, all = 0.0;
    for (int i = 0; i < 16; ++i) {
        vec2 t = texelFetch(around, clamp(at + ivec2((i & 3) - 2, (i >> 2) - 2), ivec2(0), last), 0).rg;
        float weight = max(1.0 - abs(t.g - depth) / around_reach, 0.0);
        sum += weight * t.r;
        all += weight;
    }
    result = vec2(sum / all, depth);
}
)";

const char* const kHudVertex = R"(
layout(location = 0) in vec2 pixel;
layout(location = 1) in vec2 inside;  // texture coordinate of text, pixels from the centre of a rectangle
layout(location = 2) in vec4 tint;
layout(location = 3) in vec4 form;    // half width, half height, corner radius, 1 for text
uniform vec2 size;
out vec2 at;
out vec4 hue;
flat out vec4 outline;
void main() {
    at = inside;
    hue = tint;
    outline = form;
    gl_Position = vec4(pixel / size * vec2(2.0, -2.0) + vec2(-1.0, 1.0), 0.0, 1.0);
}
)";

const char* const kHudFragment = R"(
in vec2 at;
in vec4 hue;
flat in vec4 outline;
uniform sampler2D glyphs;
out vec4 colour;
void main() {
    float cover;
    if (outline.w > 0.5) {
        cover = texture(glyphs, at).r;
    } else {
        vec2 d = abs(at) - outline.xy + outline.z;
        float distance = length(max(d, 0.0)) + min(max(d.x, d.y), 0.0) - outline.z;
        cover = clamp(0.5 - distance, 0.0, 1.0);
    }
    colour = vec4(hue.rgb, hue.a * cover);
}
)";

}  // namespace render::shaders

#include "viewer/render/gl/shaders.hpp"

namespace carom::viewer::gl::shaders {

const std::string_view frame = R"(#version 450 core
layout(std140, binding = 0) uniform Frame {
    mat4 view;           // from the drawing's coordinates to the camera's
    mat4 projection;     // from there to the screen
    mat4 light_view;     // from the drawing's coordinates to the light's
    mat4 light_projection;
    mat4 to_shadows;     // from the camera's coordinates to the map of shadows
    vec4 to_light;       // in the camera's coordinates; w: 1 with shadows
    vec4 up;             // in the camera's coordinates; w: 1 with occlusion
    vec4 sky;
    vec4 ground;
    vec4 size;           // of the picture in samples, and its inverse
    vec4 lens;           // half the picture's width and height at distance 1; near; samples of a pixel
    vec4 haze;           // where it begins, by how much it grows per metre; its most; unused
    vec4 measure;        // width of a sample at distance 1; smallest radius at distance 1; of the occlusion; of a
                         // texel of the map of shadows
};

vec3 direction_through(vec2 place) { // of the ray through a place on the screen, (-1, -1) to (1, 1), with z = -1
    return vec3(place * lens.xy, -1);
}

vec3 point_at(vec2 place, float depth) { // what the camera sees there
    return direction_through(place) * (lens.z / depth);
}

float haze_at(float distance) { return haze.z * (1 - exp(-max(distance - haze.x, 0) * haze.y)); }
)";

const std::string_view sphere_vertex = R"(
layout(std430, binding = 0) readonly buffer Bodies { uvec4 bodies[]; };
layout(std430, binding = 1) readonly buffer Radii { float radii[]; };

flat out vec3 centre;
flat out float radius;
flat out uint look;
out vec3 point; // on the triangle

// A triangle around the unit circle: less to draw than a square of two.
const vec2 corners[3] = vec2[](vec2(-1.7320508, -1), vec2(1.7320508, -1), vec2(0, 2));

void main() {
    const int body = gl_VertexID / 3;
    const vec2 corner = corners[gl_VertexID % 3] * 1.001;
    look = bodies[body].w;
    const vec4 position = vec4(uintBitsToFloat(bodies[body].xyz), 1);
#ifdef SHADOW
    centre = (light_view * position).xyz;
    radius = max(radii[body], measure.w);
    point = centre + vec3(corner * radius, radius);
    gl_Position = light_projection * vec4(point, 1);
#else
    if ((((look >> 16) & 255u) == 3u) != (PLANET == 1)) { // the other program draws it
        gl_Position = vec4(2, 2, 2, 1);
        return;
    }
    centre = (view * position).xyz;
    radius = max(radii[body], measure.y * -centre.z);
    const float away = length(centre);
    if (away > radius * 1.0001) {
        // The triangle lies before the sphere, so that its depth bounds that of the sphere, and covers the cone of rays
        // that touch it.
        const vec3 axis = centre / away;
        const vec3 u = normalize(cross(axis, abs(axis.x) < 0.7 ? vec3(1, 0, 0) : vec3(0, 1, 0)));
        const float disc = radius * sqrt((away - radius) / (away + radius));
        point = axis * (away - radius) * 0.9999 + disc * (corner.x * u + corner.y * cross(axis, u));
    } else {
        point = direction_through(corner * 2) * lens.z; // the camera is inside: all of the picture
    }
    gl_Position = projection * vec4(point, 1);
#endif
}
)";

const std::string_view sphere_fragment = R"(
flat in vec3 centre;
flat in float radius;
flat in uint look;
in vec3 point;
layout(depth_less) out float gl_FragDepth;

#ifdef SHADOW
void main() {
    const vec2 offset = point.xy - centre.xy;
    const float height2 = radius * radius - dot(offset, offset);
    if (height2 < 0) discard;
    const float z = centre.z + sqrt(height2);
    gl_FragDepth = light_projection[2].z * z + light_projection[3].z;
}
#else
layout(binding = 0) uniform sampler2D palette;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;

#if PLANET
float random(vec3 cell) { return fract(sin(dot(cell, vec3(12.9898, 78.233, 37.719))) * 43758.5453); }

float noise(vec3 at) {
    const vec3 cell = floor(at);
    const vec3 part = smoothstep(0, 1, at - cell);
    float corner[8];
    for (int i = 0; i < 8; ++i) corner[i] = random(cell + vec3(i & 1, (i >> 1) & 1, i >> 2));
    const vec4 x = mix(vec4(corner[0], corner[2], corner[4], corner[6]), vec4(corner[1], corner[3], corner[5], corner[7]), part.x);
    const vec2 y = mix(x.xz, x.yw, part.y);
    return mix(y.x, y.y, part.z);
}

float terrain(vec3 at) {
    return 0.5 * noise(at * 3) + 0.26 * noise(at * 6.3) + 0.14 * noise(at * 13.1) + 0.1 * noise(at * 27.7);
}
#endif

void main() {
    const vec3 ray = normalize(point);
    const float middle = dot(ray, centre);
    const vec3 offset = ray * middle - centre; // of the ray's point next to the centre: small numbers where it counts
    const float half_chord2 = radius * radius - dot(offset, offset);
    if (half_chord2 < 0) discard;
    const float half_chord = sqrt(half_chord2);
    const bool inside = middle < half_chord;
    const float travel = inside ? middle + half_chord : middle - half_chord;
    const vec3 hit = ray * travel;
    if (travel <= 0 || -hit.z < lens.z) discard;

    const uint row = (look >> 16) & 255u;
    float place = float(look & 65535u) / 65535.0;
    const vec3 outward = (offset - ray * (inside ? -half_chord : half_chord)) / radius;
#if PLANET
    place = terrain(transpose(mat3(view)) * outward);
#endif
    albedo = vec4(texture(palette, vec2((place * 255 + 0.5) / 256, (float(row) + 0.5) / 4)).rgb, 1);
    normal = vec4(inside ? -outward : outward, float(look >> 24) / 255.0);
    gl_FragDepth = lens.z / -hit.z;
}
#endif
)";

const std::string_view panel_vertex = R"(
layout(location = 0) uniform vec3 corner;
layout(location = 1) uniform vec3 side_u;
layout(location = 2) uniform vec3 side_v;
out vec2 place; // in the panel, 0 to 1
out vec3 point;

void main() {
    place = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    point = (view * vec4(corner + place.x * side_u + place.y * side_v, 1)).xyz;
    gl_Position = projection * vec4(point, 1);
}
)";

const std::string_view panel_fragment = R"(
layout(location = 1) uniform vec3 side_u;
layout(location = 2) uniform vec3 side_v;
layout(location = 3) uniform vec4 colour;
layout(location = 4) uniform vec2 grid; // distance of its lines, and 1 if the panel fades
in vec2 place;
in vec3 point;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;

void main() {
    // A grid that stays thin however far it is, and fades where it would blur.
    const vec2 cell = place * vec2(length(side_u), length(side_v)) / grid.x;
    const vec2 width = max(fwidth(cell), 1e-6);
    const vec2 off = abs(fract(cell - 0.5) - 0.5) / width;
    const vec2 line = clamp(1.2 - off, 0, 1) * clamp(1 - 4 * width, 0, 1);
    const float fade = grid.y > 0 ? 1 - smoothstep(0.3, 1.0, 2 * distance(place, vec2(0.5))) : 1;
    albedo = vec4(colour.rgb * (1 + 0.35 * max(line.x, line.y)), colour.a * fade);
    if (albedo.a < 0.003) discard;
    normal = vec4(normalize(mat3(view) * cross(side_u, side_v)), 0);
}
)";

const std::string_view shape_vertex = R"(
struct Corner { vec4 place; vec4 normal; };
layout(std430, binding = 3) readonly buffer Corners { Corner corners[]; };
layout(location = 0) uniform vec3 anchor;
#ifdef SHADOW
void main() { gl_Position = light_projection * light_view * vec4(anchor + corners[gl_VertexID].place.xyz, 1); }
#else
out vec3 point;
out vec3 outward;

void main() {
    const Corner corner = corners[gl_VertexID];
    point = (view * vec4(anchor + corner.place.xyz, 1)).xyz;
    outward = mat3(view) * corner.normal.xyz;
    gl_Position = projection * vec4(point, 1);
}
#endif
)";

const std::string_view shape_fragment = R"(
layout(location = 1) uniform vec4 colour;
in vec3 point;
in vec3 outward;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;

void main() {
    albedo = colour;
    normal = vec4(normalize(outward) * (gl_FrontFacing ? 1 : -1), 0);
}
)";

const std::string_view depth_fragment = "void main() {}";

const std::string_view glass_fragment = R"(
layout(location = 1) uniform vec4 colour;
in vec3 point;
in vec3 outward;
layout(location = 0) out vec4 light;

// The more aslant one looks through it, the less one sees.
void main() {
    const vec3 to_eye = normalize(-point);
    const vec3 side = normalize(outward);
    const float aslant = 1 - abs(dot(side, to_eye));
    const float shine = pow(max(dot(side, normalize(to_light.xyz + to_eye)), 0), 40);
    const float brightness = 0.45 + 0.55 * max(dot(side, to_light.xyz), 0);
    const float opacity = (0.07 + 0.35 * aslant * aslant * aslant + 0.15 * shine) * (1 - haze_at(length(point)));
    light = vec4(colour.rgb * brightness + 0.5 * shine, opacity);
}
)";

const std::string_view screen_vertex = R"(
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4 - 1, 0, 1); }
)";

const std::string_view hollow_fragment = R"(
layout(location = 0) uniform vec4 ball; // centre and radius
layout(location = 1) uniform vec4 colour;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 normal;

void main() {
    const vec3 ray = normalize(direction_through(gl_FragCoord.xy * size.zw * 2 - 1));
    const vec3 centre = (view * vec4(ball.xyz, 1)).xyz;
    const float middle = dot(ray, centre);
    const vec3 offset = ray * middle - centre;
    const float half_chord2 = ball.w * ball.w - dot(offset, offset);
    if (half_chord2 < 0) discard;
    const float travel = middle + sqrt(half_chord2);
    if (travel <= 0) discard;
    const vec3 hit = ray * travel;
    const vec3 inward = (centre - hit) / ball.w;
    const vec3 there = transpose(mat3(view)) * inward;
    const vec2 angles = vec2(atan(there.y, there.x), asin(clamp(there.z, -1, 1))) * (12 / 3.14159265);
    const vec2 width = max(fwidth(angles), 1e-6);
    const vec2 off = abs(fract(angles - 0.5) - 0.5) / width;
    const vec2 line = clamp(1.2 - off, 0, 1) * clamp(1 - 4 * width, 0, 1);
    albedo = vec4(colour.rgb * (1 + 0.35 * max(line.x, line.y)), colour.a);
    normal = vec4(inward, 0);
    gl_FragDepth = lens.z / -hit.z;
}
)";

const std::string_view occlusion_fragment = R"(
layout(binding = 0) uniform sampler2D depths;
layout(binding = 1) uniform sampler2D normals;
layout(location = 0) out float open_sky;

vec3 seen_at(ivec2 texel) {
    const ivec2 inside = clamp(texel, ivec2(0), textureSize(depths, 0) - 1);
    const float depth = texelFetch(depths, inside, 0).r;
    return point_at((vec2(inside) + 0.5) * size.zw * 2 - 1, max(depth, 1e-30));
}

// Scalable ambient obscurance: McGuire, Mara and Luebke, High Performance Graphics 2012, section 2.
void main() {
    const ivec2 texel = ivec2(gl_FragCoord.xy * lens.w);
    if (texelFetch(depths, texel, 0).r == 0) {
        open_sky = 1;
        return;
    }
    const vec3 here = seen_at(texel);
    const vec3 outward = texelFetch(normals, texel, 0).xyz;
    const float on_screen = clamp(measure.z / (measure.x * -here.z), 4 * lens.w, 90 * lens.w);
    const float reach = on_screen * measure.x * -here.z;
    const ivec2 pattern = ivec2(gl_FragCoord.xy) & 3;
    const float turn = float((4 * pattern.x + 13 * pattern.y) & 15) * (6.2831853 / 16); // each of 16 once
    const int taps = 9;
    // From tap to tap it turns by 2/9 of the circle: the taps lie on a spiral.
    const mat2 onwards = mat2(0.1736482, 0.9848078, -0.9848078, 0.1736482);
    vec2 direction = vec2(cos(turn), sin(turn));
    float sum = 0;
    for (int i = 0; i < taps; ++i) {
        const float part = (float(i) + 0.5) / float(taps);
        const vec3 there = seen_at(texel + ivec2(part * on_screen * direction));
        direction = onwards * direction;
        const vec3 way = there - here;
        const float length2 = dot(way, way);
        const float fall = max(reach * reach - length2, 0);
        const float rise = max(dot(way, outward) - 0.02 * reach, 0) / (length2 + 0.0001 * reach * reach);
        sum += fall * fall * fall * rise;
    }
    const float strength = 3.4;
    open_sky = max(0, 1 - strength * sum / (pow(reach, 5) * float(taps)));
}
)";

const std::string_view blur_fragment = R"(
layout(binding = 0) uniform sampler2D rough;
layout(binding = 1) uniform sampler2D depths;
layout(location = 0) out float open_sky;

// The mean over the 4 x 4 pixels that the directions of the occlusion repeat after, as far as they are one surface.
void main() {
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    const int scale = int(lens.w);
    const ivec2 last = textureSize(rough, 0) - 1;
    const float here = texelFetch(depths, pixel * scale, 0).r;
    float sum = 0;
    float weights = 0;
    for (int y = -2; y < 2; ++y) {
        for (int x = -2; x < 2; ++x) {
            const ivec2 other = clamp(pixel + ivec2(x, y), ivec2(0), last);
            const float there = texelFetch(depths, other * scale, 0).r;
            const float weight = abs(there - here) <= 0.02 * here ? 1 : 0.0001;
            sum += weight * texelFetch(rough, other, 0).r;
            weights += weight;
        }
    }
    open_sky = sum / weights;
}
)";

const std::string_view light_fragment = R"(
layout(binding = 0) uniform sampler2D albedos;
layout(binding = 1) uniform sampler2D normals;
layout(binding = 2) uniform sampler2D depths;
layout(binding = 3) uniform sampler2D occlusion;
layout(binding = 4) uniform sampler2DShadow shadows;
layout(location = 0) out vec4 light;

float lit(vec3 point, vec3 outward) {
    if (to_light.w == 0) return 1;
    const float slope = 1 - max(dot(outward, to_light.xyz), 0);
    const vec4 there = to_shadows * vec4(point + outward * measure.w * (1 + 2 * slope), 1);
    // The mean over 3 x 3 texels around the place. Along each side it weighs four texels by 1 - part, 1, 1 and part,
    // which are two samples between texels, so that four samples do for all of them.
    const float side = float(textureSize(shadows, 0).x);
    const vec2 at = (there.xy * 0.5 + 0.5) * side - 0.5;
    const vec2 part = fract(at);
    const vec2 low = (at - part - 0.5 + 1 / (2 - part)) / side;
    const vec2 high = (at - part + 1.5 + part / (1 + part)) / side;
    const vec2 weight = (1 + part) / 3; // of the high ones
    const float depth = max(there.z + 0.0002, 0);
    const float below = mix(texture(shadows, vec3(low, depth)), texture(shadows, vec3(high.x, low.y, depth)), weight.x);
    const float above = mix(texture(shadows, vec3(low.x, high.y, depth)), texture(shadows, vec3(high, depth)), weight.x);
    return mix(below, above, weight.y);
}

void main() {
    const ivec2 texel = ivec2(gl_FragCoord.xy);
    const float depth = texelFetch(depths, texel, 0).r;
    const vec2 place = gl_FragCoord.xy * size.zw;
    const vec3 background = mix(ground.rgb, sky.rgb, place.y);
    if (depth == 0) {
        light = vec4(background, 1);
        return;
    }
    const vec4 albedo = texelFetch(albedos, texel, 0);
    const vec4 normal = texelFetch(normals, texel, 0);
    const vec3 outward = normalize(normal.xyz);
    const vec3 point = point_at(place * 2 - 1, depth);
    const vec3 to_eye = normalize(-point);
    const float open_sky = up.w == 0 ? 1 : texture(occlusion, place).r;

    const float sun = max(dot(outward, to_light.xyz), 0);
    const float shadow = sun > 0 ? lit(point, outward) : 0;
    const vec3 half_way = normalize(to_light.xyz + to_eye);
    const float shine = 0.16 * pow(max(dot(outward, half_way), 0), 50) * shadow;
    const vec3 from_sky = mix(vec3(0.15, 0.14, 0.14), vec3(0.36, 0.40, 0.47), 0.5 + 0.5 * dot(outward, up.xyz)) * open_sky;
    const vec3 from_eye = vec3(0.10) * max(dot(outward, to_eye), 0) * open_sky;
    vec3 colour = albedo.rgb * (from_sky + from_eye + vec3(1.25, 1.19, 1.08) * sun * shadow * mix(1.0, open_sky, 0.35)) + shine;
    colour += normal.w * (albedo.rgb * 0.6 + vec3(0.5, 0.38, 0.2));
    light = vec4(mix(background, colour, albedo.a * (1 - haze_at(length(point)))), 1);
}
)";

const std::string_view line_vertex = R"(
struct Line { vec4 from; vec4 to; vec4 colour_from; vec4 colour_to; }; // from.w: width
layout(std430, binding = 2) readonly buffer Lines { Line lines[]; };
out vec4 colour;
out vec2 across; // pixels from the middle, and half the width

void main() {
    const Line line = lines[gl_VertexID / 6];
    const int corner = int[](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
    vec3 a = (view * vec4(line.from.xyz, 1)).xyz;
    vec3 b = (view * vec4(line.to.xyz, 1)).xyz;
    const float near = lens.z * 1.01;
    if (a.z > -near && b.z > -near) { // behind the camera
        gl_Position = vec4(2, 2, 2, 1);
        return;
    }
    if (a.z > -near) a = mix(b, a, (b.z + near) / (b.z - a.z));
    if (b.z > -near) b = mix(a, b, (a.z + near) / (a.z - b.z));
    const vec4 clip_a = projection * vec4(a, 1);
    const vec4 clip_b = projection * vec4(b, 1);
    const vec2 way = (clip_b.xy / clip_b.w - clip_a.xy / clip_a.w) * size.xy;
    const vec2 aside = normalize(vec2(-way.y, way.x) + vec2(1e-6, 0));
    const float half_width = 0.5 * line.from.w * lens.w;
    const float side = (corner & 1) == 0 ? -1 : 1;
    const bool at_end = corner > 1;
    vec4 place = at_end ? clip_b : clip_a;
    place.xy += aside * side * (half_width + 1) * 2 * size.zw * place.w;
    place.z *= 1.0002; // a little nearer: a line on a surface is before it
    colour = at_end ? line.colour_to : line.colour_from;
    colour.a *= 1 - haze_at(length(at_end ? b : a));
    across = vec2(side * (half_width + 1), half_width);
    gl_Position = place;
}
)";

const std::string_view line_fragment = R"(
in vec4 colour;
in vec2 across;
layout(location = 0) out vec4 light;
void main() { light = vec4(colour.rgb, colour.a * clamp(across.y + 0.5 - abs(across.x), 0, 1)); }
)";

const std::string_view resolve_fragment = R"(
layout(binding = 0) uniform sampler2D light;
layout(location = 0) out vec4 shown;

vec3 as_shown(vec3 linear) { // sRGB
    return mix(12.92 * linear, 1.055 * pow(linear, vec3(1 / 2.4)) - 0.055, step(0.0031308, linear));
}

void main() {
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    const int samples = int(lens.w);
    vec3 sum = vec3(0);
    for (int y = 0; y < samples; ++y) {
        for (int x = 0; x < samples; ++x) {
            sum += clamp(texelFetch(light, pixel * samples + ivec2(x, y), 0).rgb, 0, 1);
        }
    }
    // Ordered noise of less than a step keeps smooth backgrounds from showing bands.
    const int noise = ((pixel.x ^ pixel.y) * 7 + pixel.x * 3 + pixel.y * 5) & 15;
    shown = vec4(as_shown(sum / float(samples * samples)) + (float(noise) / 15 - 0.5) / 255, 1);
}
)";

} // namespace carom::viewer::gl::shaders

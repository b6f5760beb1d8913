/* GLSL of the world, its shadow map, and the last pass, which encodes the picture for the display. */
#include "shaders.h"

const char *const SCENE_VERTEX =
    "#version 330 core\n"
    "layout(location = 0) in vec3 position;\n"
    "layout(location = 1) in vec3 normal;\n"
    "layout(location = 2) in vec3 albedo;\n"
    "layout(location = 3) in float road;\n"
    "layout(location = 4) in float sunlit;\n"
    "uniform vec3 eye;\n"
    "uniform mat4 to_clip, to_shadow;\n"
    "out vec3 v_position, v_normal, v_albedo, v_shadow;\n"
    "out float v_road, v_sunlit, v_distance;\n"
    "void main() {\n"
    "    v_position = position; v_normal = normal; v_albedo = albedo; v_road = road; v_sunlit = sunlit;\n"
    "    v_shadow = (to_shadow * vec4(position, 1.0)).xyz * 0.5 + 0.5;\n"
    "    v_distance = length(position - eye);\n"
    "    gl_Position = to_clip * vec4(position - eye, 1.0);\n"
    "}\n";

const char *const SCENE_FRAGMENT =
    "#version 330 core\n"
    "in vec3 v_position, v_normal, v_albedo, v_shadow;\n"
    "in float v_road, v_sunlit, v_distance;\n"
    "uniform bool ground;\n"
    "uniform vec2 pad;\n"               /* east, north, m */
    "uniform vec3 sun_direction;\n"
    "uniform vec3 sun_illuminance;\n"   /* on a surface facing the sun */
    "uniform vec3 ambient[9];\n"        /* radiance of the sky as spherical harmonics */
    "uniform sampler2DShadow shadow_map;\n"
    "uniform float per_unit;\n"         /* 1 / luminance of the picture value 1 */
    "layout(location = 0) out vec4 colour;\n"
    "layout(location = 1) out vec4 surface_class;\n"
    "const float PI = 3.14159265;\n"

    /* Value noise; octaves finer than a pixel's footprint fade to their mean. */
    "float hash(ivec2 p) {\n"
    "    uint h = uint(p.x) * 0x8da6b343u ^ uint(p.y) * 0xd8163841u;\n"
    "    h = (h ^ (h >> 15u)) * 0x2c1b3c6du; h = (h ^ (h >> 12u)) * 0x297a2d39u;\n"
    "    return float(h >> 8u) / 16777216.0;\n"
    "}\n"
    "float noise(float size, float footprint) {\n"
    "    vec2 p = v_position.xy / size, f = fract(p);\n"
    "    ivec2 i = ivec2(floor(p));\n"
    "    f = f * f * (3.0 - 2.0 * f);\n"
    "    float n = mix(mix(hash(i), hash(i + ivec2(1, 0)), f.x), mix(hash(i + ivec2(0, 1)), hash(i + ivec2(1, 1)), f.x), f.y);\n"
    "    return mix(n, 0.5, smoothstep(0.3, 1.0, footprint / size));\n"
    "}\n"

    /* The pad's dirt has a ragged edge. */
    "float pad_edge(float foot) { return length(v_position.xy - pad) + 5.0 * (noise(3.0, foot) - 0.5); }\n"
    "float footprint() { return sqrt(length(dFdx(v_position.xy)) * length(dFdy(v_position.xy))); }\n"

    "vec3 ground_albedo(vec3 n) {\n"
    "    float foot = footprint();\n"
    "    float fine = noise(0.35, foot), small = noise(2.1, foot), mid = noise(17.0, foot);\n"
    "    float large = noise(160.0, foot), huge = noise(900.0, foot);\n"
    "    vec3 meadow = mix(vec3(0.075, 0.095, 0.030), vec3(0.165, 0.140, 0.060), 0.55 * large + 0.45 * mid);\n"
    "    meadow *= 0.55 + 0.45 * fine + 0.45 * small;\n"
    "    vec3 autumn = mix(vec3(0.115, 0.060, 0.018), vec3(0.140, 0.095, 0.025), small);\n"
    "    vec3 wood = mix(vec3(0.032, 0.050, 0.020), autumn, smoothstep(0.45, 0.75, 0.6 * huge + 0.4 * mid));\n"
    "    wood *= 0.6 + 0.8 * mid * (0.5 + small);\n"
    "    float wooded = smoothstep(700.0, 1000.0, length(v_position.xy));\n"
    "    wooded *= smoothstep(0.30, 0.42, 0.5 * large + 0.5 * huge + 0.6 * (1.0 - n.z));\n"
    "    vec3 albedo = mix(meadow, wood, wooded);\n"
    "    vec3 rock = vec3(0.15, 0.13, 0.105) * (0.6 + 0.8 * small);\n"
    "    albedo = mix(albedo, rock, smoothstep(0.80, 0.70, n.z));\n"
    "    vec3 gravel = vec3(0.23, 0.205, 0.17) * (0.7 + 0.35 * fine + 0.25 * small);\n"
    "    vec3 dirt = vec3(0.16, 0.105, 0.065) * (0.6 + 0.5 * fine + 0.3 * small);\n"
    "    albedo = mix(dirt, albedo, smoothstep(9.0, 12.0, pad_edge(foot)));\n"
    "    float soft = foot * 0.7 + 0.01, d = abs(v_road);\n"
    "    albedo = mix(gravel, albedo, smoothstep(4.6 - soft, 5.2 + soft, d + 0.8 * (mid - 0.5)));\n"
    "    vec3 asphalt = vec3(0.075) * (0.8 + 0.4 * fine);\n"
    "    float line = smoothstep(0.08 + soft, 0.05 - soft, abs(d - 0.16)) + smoothstep(0.08 + soft, 0.05 - soft, abs(d - 3.2));\n"
    "    asphalt = mix(asphalt, mix(vec3(0.55, 0.36, 0.04), vec3(0.6), step(1.5, d)), clamp(line, 0.0, 1.0) * smoothstep(0.5, 0.1, soft));\n"
    "    return mix(asphalt, albedo, smoothstep(3.5 - soft, 3.6 + soft, d));\n"
    "}\n"

    /* Returns a wk_surface_class. On the ground: paved road, soil beside it and on the pad, rock on steep faces,
     * vegetation elsewhere. Objects: vegetation if they are green, else building. */
    "float made_of(vec3 n) {\n"
    "    if (!ground) return v_albedo.g > 1.5 * v_albedo.r ? 4.0 : 6.0;\n"
    "    if (abs(v_road) < 3.55) return 3.0;\n"
    "    if (abs(v_road) < 4.9 || pad_edge(footprint()) < 10.5) return 1.0;\n"
    "    return n.z < 0.75 ? 2.0 : 4.0;\n"
    "}\n";

/* Lighting of the ground and all objects. */
const char *const SCENE_FRAGMENT_END =
    "uniform vec3 lamp_position[2], lamp_direction[2], lamp_intensity;\n"
    "uniform vec2 lamp_cosines;\n"     /* of the angle where the beam ends, of the angle where it starts to fade */
    "uniform vec3 deck_foot, deck_right;\n" /* centre of a bridge's underside; direction across the road */
    "uniform vec2 deck_half;\n"        /* 0: no bridge */

    "float sun_visibility(float cosine) {\n"
    "    if (any(lessThan(v_shadow, vec3(0.0))) || any(greaterThan(v_shadow, vec3(1.0)))) return v_sunlit;\n"
    "    vec2 texel = 1.0 / vec2(textureSize(shadow_map, 0));\n"
    "    float bias = 0.0006 + 0.0012 * (1.0 - cosine), lit = 0.0;\n"
    "    for (int y = -1; y <= 1; y++)\n"
    "        for (int x = -1; x <= 1; x++)\n"
    "            lit += texture(shadow_map, vec3(v_shadow.xy + vec2(x, y) * texel, v_shadow.z - bias));\n"
    "    return v_sunlit * lit / 9.0;\n"
    "}\n"

    /* Cosine-weighted integral of the sky's radiance (Ramamoorthi & Hanrahan 2001). */
    "vec3 sky_irradiance(vec3 n) {\n"
    "    vec3 e = PI * 0.282095 * ambient[0];\n"
    "    e += (2.0 * PI / 3.0) * 0.488603 * (ambient[1] * n.y + ambient[2] * n.z + ambient[3] * n.x);\n"
    "    e += (PI / 4.0) * (1.092548 * (ambient[4] * n.x * n.y + ambient[5] * n.y * n.z + ambient[7] * n.x * n.z)\n"
    "        + 0.315392 * ambient[6] * (3.0 * n.z * n.z - 1.0) + 0.546274 * ambient[8] * (n.x * n.x - n.y * n.y));\n"
    "    return max(e, vec3(0.0));\n"
    "}\n"

    /* Share of the sky over level ground that a level rectangle hides, when one of its corners is above the point and
     * the opposite one is at `a`, divided by its height. Odd in both components, so that four corners make any
     * rectangle (Howell, Catalog of Radiation Heat Transfer Configuration Factors, B-4). */
    "float hidden_by(vec2 a) {\n"
    "    vec2 r = inversesqrt(1.0 + a * a);\n"
    "    return (a.x * r.x * atan(a.y * r.x) + a.y * r.y * atan(a.x * r.y)) / (2.0 * PI);\n"
    "}\n"
    "float sky_left(vec3 n) {\n"
    "    vec3 p = v_position - deck_foot;\n"
    "    if (deck_half.x == 0.0 || p.z > 0.02 || (p.z > -0.02 && n.z > 0.5)) return 1.0;\n"
    "    vec2 at = vec2(dot(p.xy, deck_right.xy), dot(p.xy, vec2(-deck_right.y, deck_right.x)));\n"
    /* The underside is lit by the ground in the deck's own shade. */
    "    if (p.z > -0.02 && n.z < -0.5) return 0.35;\n"
    "    float below = max(-p.z, 0.02);\n"
    "    vec2 a = (-deck_half - at) / below, b = (deck_half - at) / below;\n"
    "    return 1.0 - (hidden_by(b) - hidden_by(vec2(a.x, b.y)) - hidden_by(vec2(b.x, a.y)) + hidden_by(a));\n"
    "}\n"

    "vec3 lamp_light(vec3 n) {\n"
    "    vec3 light = vec3(0.0);\n"
    "    for (int i = 0; i < 2; i++) {\n"
    "        vec3 to = v_position - lamp_position[i], d = normalize(to);\n"
    "        float beam = smoothstep(lamp_cosines.x, lamp_cosines.y, dot(d, normalize(lamp_direction[i])));\n"
    "        light += lamp_intensity * (beam * max(-dot(n, d), 0.0) / dot(to, to));\n"
    "    }\n"
    "    return light;\n"
    "}\n"

    "void main() {\n"
    "    vec3 n = normalize(v_normal);\n"
    "    vec3 albedo = ground ? ground_albedo(n) : v_albedo;\n"
    "    float cosine = max(dot(n, sun_direction), 0.0);\n"
    "    vec3 irradiance = sun_illuminance * (cosine > 0.0 ? cosine * sun_visibility(cosine) : 0.0);\n"
    "    irradiance += sky_irradiance(n) * sky_left(n);\n"
    "    if (lamp_intensity.g > 0.0) irradiance += lamp_light(n);\n"
    "    colour = vec4(min(albedo / PI * irradiance * per_unit, vec3(60000.0)), 1.0);\n"
    "    surface_class = vec4(made_of(n) / 255.0, 0.0, 0.0, 1.0);\n"
    "}\n";

const char *const SHADOW_VERTEX =
    "#version 330 core\n"
    "layout(location = 0) in vec3 position;\n"
    "uniform mat4 to_shadow;\n"
    "void main() { gl_Position = to_shadow * vec4(position, 1.0); }\n";

const char *const SHADOW_FRAGMENT =
    "#version 330 core\n"
    "void main() {}\n";

/* One triangle that covers the whole picture. */
const char *const PRESENT_VERTEX =
    "#version 330 core\n"
    "void main() {\n"
    "    vec2 at = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);\n"
    "    gl_Position = vec4(at * 2.0 - 1.0, 0.0, 1.0);\n"
    "}\n";

const char *const PRESENT_FRAGMENT =
    "#version 330 core\n"
    "uniform sampler2D picture;\n"
    "uniform int finer;\n"        /* samples along each side of a displayed pixel */
    "uniform float exposure;\n"   /* 0: the picture is tone-mapped already */
    "out vec4 encoded;\n"
    "uniform float grain;\n"      /* 1: hides 8-bit banding; 0: none, for small files */
    "float dither(uvec2 p) {\n"
    "    uint h = p.x * 0x8da6b343u ^ p.y * 0xd8163841u;\n"
    "    h = (h ^ (h >> 15u)) * 0x2c1b3c6du; h = (h ^ (h >> 12u)) * 0x297a2d39u;\n"
    "    return float(h >> 8u) / 16777216.0 - 0.5;\n"
    "}\n"
    "void main() {\n"
    /* Samples are averaged after tone mapping, as display light. Averaged before it, an edge in front of the sun would
     * stay jagged. */
    "    ivec2 first = ivec2(gl_FragCoord.xy) * finer;\n"
    "    vec3 x = vec3(0.0);\n"
    "    for (int i = 0; i < finer * finer; i++) {\n"
    "        vec3 s = texelFetch(picture, first + ivec2(i % finer, i / finer), 0).rgb;\n"
    "        x += clamp(exposure > 0.0 ? 1.0 - exp(-s * exposure) : s, 0.0, 1.0);\n"
    "    }\n"
    "    x /= float(finer * finer);\n"
    "    vec3 s = mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, vec3(lessThanEqual(x, vec3(0.0031308))));\n"
    "    encoded = vec4(s + grain * dither(uvec2(gl_FragCoord.xy)) / 255.0, 1.0);\n"
    "}\n";

// Conversion of luminance to display values: exposure, tone curve, sRGB encoding, dither. The CPU version is
// src/light/tone.rs.

alias Luminance = vec3f; // cd/m^2, linear Rec. 709
alias Display = vec3f;   // 1 = display white, linear Rec. 709

const TONE_LINEAR: u32 = 0u;
const TONE_EXPONENTIAL: u32 = 1u;
const TONE_FILMIC: u32 = 2u;

// Curves that a pipeline can draw, one bit each.
override CURVES: u32 = 7u;

// 1 - exp(-x) for each channel (O'Neil 2005, eq. 4.1 of Elek 2008).
fn tone_exponential(x: Display) -> Display {
    return 1.0 - exp(-x);
}

// Shoulder and toe of the filmic curve (Hable 2010) for each channel.
fn hable(x: Display) -> Display {
    return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.0666666667;
}

// Filmic curve for each channel: hable(2 x) / hable(11.2).
fn tone_filmic(x: Display) -> Display {
    return hable(min(x, vec3f(1e4)) * 2.0) / hable(vec3f(11.2));
}

// Whether `curve` is `asked`. Always true in a pipeline that draws only this curve, always false in one that cannot
// draw it.
fn is_curve(curve: u32, asked: u32) -> bool {
    let bit = 1u << asked;
    return CURVES == bit || ((CURVES & bit) != 0u && curve == asked);
}

// Display value of exposed light by a tone curve.
fn tone_curve(curve: u32, x: Display) -> Display {
    if is_curve(curve, TONE_EXPONENTIAL) {
        return tone_exponential(x);
    }
    if is_curve(curve, TONE_FILMIC) {
        return tone_filmic(x);
    }
    return x;
}

// Encodes linear values by the sRGB curve (IEC 61966-2-1).
fn srgb_encode(x: Display) -> vec3f {
    let c = clamp(x, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(c, vec3f(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3f(0.0031308));
}

// Inverse of srgb_encode.
fn srgb_decode(v: vec3f) -> Display {
    let c = clamp(v, vec3f(0.0), vec3f(1.0));
    return select(pow((c + 0.055) / 1.055, vec3f(2.4)), c / 12.92, c <= vec3f(0.04045));
}

// Hash of the pixel and the host's frame (PCG, Jarzynski & Olano 2020): three uniform numbers in [0, 1).
fn pixel_noise(pixel: vec2u, frame: u32) -> vec3f {
    var v = vec3u(pixel, frame) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> vec3u(16u));
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return vec3f(v >> vec3u(8u)) / 16777216.0;
}

// Triangular dither with an amplitude of one quantisation step to either side: it removes banding without bias. It is
// limited near both ends of the range, so that black stays black.
fn dither(encoded: vec3f, step: f32, pixel: vec2u, frame: u32) -> vec3f {
    let n = pixel_noise(pixel, frame) - pixel_noise(pixel, frame + 0x9e3779b9u);
    let room = min(encoded, 1.0 - encoded);
    return encoded + clamp(n * step, -room, room);
}

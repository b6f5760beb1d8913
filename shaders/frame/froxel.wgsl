// Positions and contents of the veil's textures: light and transmittance over (picture, distance), tiled in two
// textures. The host samples them with the published snippets (shaders/snippets), which have the same mapping.
//!include "common/fullscreen.wgsl"
//!include "common/tone.wgsl"
//!include "between/veil.wgsl"

// Texels of one distance slice, and numbers of slices side by side and one above the other.
const FROXEL_TILE: vec2f = vec2f(32.0, 18.0);
const FROXEL_TILES: vec2f = vec2f(8.0, 4.0);
// Distance of slice s of 32, m: NEAR ((FAR / NEAR + 1)^(s / 31) - 1), with FAR = 1e5 m.
const FROXEL_NEAR: f32 = 20.0;
const FROXEL_LOG: f32 = 8.5173932; // ln(1e5/20 + 1)

// Texel of both textures.
struct Froxel {
    @location(0) light: vec4f,
    @location(1) through: vec4f,
}

// Position whose veil a texel holds. `distance` is along the ray, m.
struct FroxelPlace {
    ndc: vec2f,
    distance: f32,
}

// Position of a texel.
fn froxel_place(position: vec2f) -> FroxelPlace {
    let texel = floor(position);
    let tile = floor(texel / FROXEL_TILE);
    let inside = texel - tile * FROXEL_TILE;
    let slice = tile.x + tile.y * FROXEL_TILES.x;
    // Texel centres at the tile's edge lie on the picture's edge, so that filtered look-ups do not leave the tile.
    let uv = inside / (FROXEL_TILE - 1.0);
    let ndc = frame_ndc(uv);
    return FroxelPlace(ndc, FROXEL_NEAR * (exp(slice / 31.0 * FROXEL_LOG) - 1.0));
}

// Pixel of the picture that a ray passes through.
fn picture_pixel(ndc: vec2f) -> vec2i {
    let uv = vec2f(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y * frame.y_sign);
    return vec2i(clamp(uv * frame.picture, vec2f(0.0), frame.picture - 1.0));
}

// Veil of air, clouds and fog in front of a position.
fn froxel_veil(at: FroxelPlace) -> Veil {
    drawn = frame.drawn;
    let ray = view_ray(frame.depth, at.ndc);
    let sky = sky_sample_in(picture_pixel(at.ndc), at.distance);
    return veil_between(ray, at.distance, at.distance / ray.slant * frame.depth.plane_scale, sky);
}

// Texel with the values of a veil.
fn froxel_of(veil: Veil) -> Froxel {
    // Exposed light fits half floats, whose maximum is 65504; scene-linear hosts undo the exposure by light_scale.
    var light = veil.light * frame.exposure;
    if frame.color_space != 0u {
        light = tone_curve(frame.tone, light);
    }
    return Froxel(vec4f(light, 1.0), vec4f(veil.transmittance, 1.0));
}

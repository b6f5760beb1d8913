// Where a texel of the veil's textures lies, and what it holds: light and transmittance over (picture, distance), tiled
// in two textures. The host samples them with the published snippets (shaders/snippets); the mapping is theirs too.
//!include "common/fullscreen.wgsl"
//!include "common/tone.wgsl"
//!include "between/veil.wgsl"

const FROXEL_TILE: vec2f = vec2f(32.0, 18.0);
const FROXEL_TILES: vec2f = vec2f(8.0, 4.0);
// Slice s of 32 lies at distance NEAR (FAR/NEAR + 1)^(s/31) - NEAR, m.
const FROXEL_NEAR: f32 = 20.0;
const FROXEL_LOG: f32 = 8.5173932; // ln(1e5/20 + 1)

struct Froxel {
    @location(0) light: vec4f,
    @location(1) through: vec4f,
}

struct FroxelPlace {
    ndc: vec2f,
    distance: f32,
}

fn froxel_place(position: vec2f) -> FroxelPlace {
    let texel = floor(position);
    let tile = floor(texel / FROXEL_TILE);
    let inside = texel - tile * FROXEL_TILE;
    let slice = tile.x + tile.y * FROXEL_TILES.x;
    // Texel centres at the tile's edge lie on the picture's edge, so that no lookup leaves the tile.
    let uv = inside / (FROXEL_TILE - 1.0);
    let ndc = frame_ndc(uv);
    return FroxelPlace(ndc, FROXEL_NEAR * (exp(slice / 31.0 * FROXEL_LOG) - 1.0));
}

// The picture's pixel that a ray goes through.
fn picture_pixel(ndc: vec2f) -> vec2i {
    let uv = vec2f(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y * frame.y_sign);
    return vec2i(clamp(uv * frame.picture, vec2f(0.0), frame.picture - 1.0));
}

// Air, clouds and fog before a place.
fn froxel_veil(at: FroxelPlace) -> Veil {
    drawn = frame.drawn;
    let ray = view_ray(frame.depth, at.ndc);
    let hung = hung_in(picture_pixel(at.ndc), at.distance);
    return veil_between(ray, at.distance, at.distance / ray.slant * frame.depth.plane_scale, hung);
}

fn froxel_of(veil: Veil) -> Froxel {
    // Exposed light fits fp16, whose numbers end at 65504; scene-linear hosts turn it back by light_scale.
    var light = veil.light * frame.exposure;
    if frame.color_space != 0u {
        light = tone_curve(frame.tone, light);
    }
    return Froxel(vec4f(light, 1.0), vec4f(veil.transmittance, 1.0));
}

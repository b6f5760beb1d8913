// Draws fog into a picture: at every pixel, or by a look-up in cells over (picture, distance). In the uniform block the
// fog comes before the depth, as in Welkin's own binding.
struct Both { fog: FogUniform, depth: DepthUniform }
@group(0) @binding(0) var<uniform> u: Both;
@group(0) @binding(1) var colour: texture_2d<f32>;
@group(0) @binding(2) var depth: texture_2d<f32>;
@group(1) @binding(0) var cell_light: texture_2d<f32>;
@group(1) @binding(1) var cell_through: texture_2d<f32>;
@group(1) @binding(2) var cell_sampler: sampler;

override CELLS_X: f32 = 32.0;
override CELLS_Y: f32 = 18.0;
override CELLS_Z: f32 = 32.0;
override ACROSS: f32 = 6.0;
// Slice s lies at NEAR ((FAR/NEAR + 1)^(s/(n - 1)) - 1), as in frame/froxels.wgsl.
const CELL_NEAR: f32 = 20.0;
const CELL_LOG: f32 = 8.5173932;

@fragment
fn fogged(in: FullscreenVarying) -> @location(0) vec4f {
    let ndc = vec2f(2.0 * in.uv.x - 1.0, 1.0 - 2.0 * in.uv.y);
    let d = textureLoad(depth, vec2i(in.position.xy), 0).r;
    let ray = view_ray(u.depth, ndc);
    let w = view_depth(u.depth, d, ndc);
    let fog = fog_along(u.fog, ray.origin, ray.direction, min(w * ray.slant, RANGE_SKY), w);
    return vec4f(fog_apply(fog, textureLoad(colour, vec2i(in.position.xy), 0).rgb), 1.0);
}

struct Cell {
    @location(0) light: vec4f,
    @location(1) through: vec4f,
}

@fragment
fn froxels_fill(in: FullscreenVarying) -> Cell {
    let cells = vec2f(CELLS_X, CELLS_Y);
    let texel = floor(in.position.xy);
    let tile = floor(texel / cells);
    let slice = tile.x + tile.y * ACROSS;
    let uv = (texel - tile * cells) / (cells - 1.0);
    let ray = view_ray(u.depth, vec2f(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0));
    let range = CELL_NEAR * (exp(slice / (CELLS_Z - 1.0) * CELL_LOG) - 1.0);
    let fog = fog_along(u.fog, ray.origin, ray.direction, range, range / ray.slant);
    return Cell(vec4f(fog.radiance, 1.0), vec4f(fog.transmittance, 1.0));
}

fn cell_place(uv: vec2f, slice: f32) -> vec2f {
    let cells = vec2f(CELLS_X, CELLS_Y);
    let row = floor(slice / ACROSS);
    let tile = vec2f(slice - row * ACROSS, row);
    return tile * cells + 0.5 + uv * (cells - 1.0);
}

@fragment
fn froxels_apply(in: FullscreenVarying) -> @location(0) vec4f {
    let ndc = vec2f(2.0 * in.uv.x - 1.0, 1.0 - 2.0 * in.uv.y);
    let d = textureLoad(depth, vec2i(in.position.xy), 0).r;
    let ray = view_ray(u.depth, ndc);
    let range = min(view_depth(u.depth, d, ndc) * ray.slant, RANGE_SKY);
    let at = clamp(log(range / CELL_NEAR + 1.0) / CELL_LOG, 0.0, 1.0) * (CELLS_Z - 1.0);
    let near = min(floor(at), CELLS_Z - 2.0);
    let size = vec2f(textureDimensions(cell_light));
    let a = cell_place(in.uv, near) / size;
    let b = cell_place(in.uv, near + 1.0) / size;
    let light = mix(textureSampleLevel(cell_light, cell_sampler, a, 0.0), textureSampleLevel(cell_light, cell_sampler, b, 0.0), at - near);
    let through = mix(textureSampleLevel(cell_through, cell_sampler, a, 0.0), textureSampleLevel(cell_through, cell_sampler, b, 0.0), at - near);
    return vec4f(textureLoad(colour, vec2i(in.position.xy), 0).rgb * through.rgb + light.rgb, 1.0);
}

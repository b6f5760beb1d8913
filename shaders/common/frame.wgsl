// What a frame knows: the camera's rays, the light that no lamp of the sky sends, and how the host's numbers are read.
//!include "common/depth.wgsl"
//!include "common/guarded.wgsl"

const MAX_FLASHES: u32 = 8u;

// A place that the light of a flash of lightning comes from.
struct FlashSource {
    // Camera-relative, m.
    position: vec3f,
    // What the face of the clouds sends of it, cd (between/flash.wgsl).
    clouds: f32,
    // Luminous intensity in the air, cd; 0 of what shines inside a cloud.
    air: f32,
    // How far the light reaches about the position, m.
    radius: f32,
    // Distance from the face of the clouds, m.
    height: f32,
    pad: f32,
}

struct FrameUniform {
    // Axes: camera-local east-north-up.
    depth: DepthUniform,
    // Columns: linear Rec. 709 colour, cd/m^2, of what the sky passes on at each of the planet's three wavelengths.
    color: array<vec4f, 3>,
    // Mean luminance of the moonless sky between the stars, cd/m^2 a channel.
    night_floor: vec3f,
    // Display units per cd/m^2.
    exposure: f32,
    // Zenith luminance of the cloud deck's underside, cd/m^2 a channel.
    deck: vec3f,
    // Share of the sky that the deck hides.
    deck_cover: f32,
    // cd/m^2 per unit of the host's colour (scene-linear hosts).
    cd_m2_per_unit: f32,
    // 0 scene-linear, 1 display-linear, 2 display with sRGB values in a plain texture.
    color_space: u32,
    // The tone curve (tone.wgsl).
    tone: u32,
    // Seed of the dither: the host's frame_id.
    seed: u32,
    // 1 where row 0 of the target is the picture's top, -1 where it is the bottom (OpenGL textures).
    y_sign: f32,
    // Quantisation step of the target for the dither, 0 for float targets.
    dither_step: f32,
    // Angle of a pixel in the picture's middle, rad.
    pixel_angle: f32,
    // 1 encodes the result by the sRGB curve: a plain 8- or 10-bit target that holds display values.
    encode: u32,
    // Share of the clear sky's light that scatters towards the camera below clouds.
    medium_share: f32,
    // Share of the sun's or moon's direct light that clouds let through.
    direct_share: f32,
    // Of what falls: what drawn drops hide, 1/m, up to which distance, m; the veil leaves that to them.
    drops: vec2f,
    // How much of air, fog, clear sky and drops is drawn, 1 all of it, 0 not at all (src/plan).
    drawn: vec4f,
    // How often the gauge composes: everything, and without each part.
    compositions: u32,
    // The share of the layer behind the sky times that of the clear sky.
    behind_drawn: f32,
    // cd/m^2 per unit of the layer behind the sky, and the share of it that stands in the night floor's place.
    behind: vec2f,
    // Colour of the light of flashes of lightning, of luminance 1, and how many places it comes from.
    flash_color: vec3f,
    flash_count: u32,
    // Height of the clouds' face over the camera, m, their cover, what the haze before them takes, 1/m, and what
    // scatters in the air, 1/m.
    flash_plane: f32,
    flash_cover: f32,
    flash_haze: f32,
    flash_scattering: f32,
    flashes: array<FlashSource, MAX_FLASHES>,
    // Direct light over all light on level ground, a channel, over its share that clouds let through on the mean; that
    // share.
    cloud_shadow: vec4f,
    // Pixels of the picture.
    picture: vec2f,
    // How much of the clouds is drawn as a volume, not as a deck (src/plan), and how far their base lies over the
    // camera, m.
    clouds_drawn: f32,
    clouds_over: f32,
    // The mean light of clouds that may be drawn as a volume, cd/m^2, and their cover; 0 without any.
    mean_cloud: vec4f,
    // Of falling snow, as drops: what drawn flakes hide, 1/m, up to which distance, m.
    flakes: vec2f,
    // A power of two: what light is multiplied by to be about 1 where it is white (frame/even.wgsl).
    even_scale: f32,
    // What bows add to the phase function of drops, 1/sr a channel: two tables over the angle (between/bow.wgsl).
    bows: array<vec4f, 320>,
}

// Colour of light at the planet's three wavelengths. The purest blues lie outside of Rec. 709: their negative parts are
// cut.
fn color_of(spectrum: vec3f) -> vec3f {
    let c = frame.color[0].xyz * spectrum.x + frame.color[1].xyz * spectrum.y + frame.color[2].xyz * spectrum.z;
    return not_negative(c);
}

@group(0) @binding(0) var<uniform> frame: FrameUniform;

// Normalised device coordinates of a place in the picture, of which (0, 0) is the upper left corner.
fn frame_ndc(uv: vec2f) -> vec2f {
    return vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * frame.y_sign);
}

// As frame.drawn; the gauge (plan/gauge.wgsl) sets it to see what a part is worth.
var<private> drawn: vec4f;

// Optical depth that what is drawn before the picture hides of what falls up to a range.
fn depth_of_drawn(range: f32) -> f32 {
    return frame.drops.x * min(range, frame.drops.y) + frame.flakes.x * min(range, frame.flakes.y);
}

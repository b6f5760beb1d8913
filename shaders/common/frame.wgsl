// Uniform block of a frame: the camera's rays, light of the night sky, flashes and clouds, and the host's units.
//!include "common/depth.wgsl"
//!include "common/guarded.wgsl"

const MAX_FLASHES: u32 = 8u;

// Source of a lightning flash's light.
struct FlashSource {
    // Position, camera-relative, m.
    position: vec3f,
    // Factor k of the light from the clouds' face, cd (flash_on_clouds in between/flash.wgsl).
    clouds: f32,
    // Luminous intensity in the air, cd; 0 for a source inside a cloud.
    air: f32,
    // Radius of the source, m.
    radius: f32,
    // Distance of the source from the face of the clouds, m.
    height: f32,
    pad: f32,
}

struct FrameUniform {
    // Constants of the camera's rays; axes are camera-local east, north, up.
    depth: DepthUniform,
    // Columns: linear Rec. 709 colour, cd/m^2, of radiance at each of the planet's three wavelengths.
    color: array<vec4f, 3>,
    // Mean luminance of the moonless sky between the stars, cd/m^2 for each channel.
    night_floor: vec3f,
    // Display units per cd/m^2.
    exposure: f32,
    // Zenith luminance of the cloud deck's underside, cd/m^2 for each channel.
    deck: vec3f,
    // Share of the sky that the deck hides.
    deck_cover: f32,
    // cd/m^2 per unit of the host's colour (scene-linear hosts).
    cd_m2_per_unit: f32,
    // 0 scene-linear, 1 display-linear, 2 display with sRGB values in a plain texture.
    color_space: u32,
    // Tone curve (tone.wgsl).
    tone: u32,
    // Seed of the dither, the host's frame_id.
    seed: u32,
    // 1 if row 0 of the target is the picture's top, -1 if it is the bottom (OpenGL textures).
    y_sign: f32,
    // Quantisation step of the target for the dither, 0 for float targets.
    dither_step: f32,
    // Angular size of a pixel in the picture's middle, rad.
    pixel_angle: f32,
    // 1 if the result is encoded by the sRGB curve: for a plain 8- or 10-bit target that holds display values.
    encode: u32,
    // Mean share of sunlight, direct and diffuse, that the clouds let through to the air below them.
    medium_share: f32,
    // Share of the direct light of sun or moon that clouds let through.
    direct_share: f32,
    // Extinction of the rain that drawn drops replace, 1/m, and the distance up to which they replace it, m. The veil
    // leaves out this extinction.
    drops: vec2f,
    // Drawn shares of air, fog, clear sky and drops, 0 to 1 (src/plan).
    drawn: vec4f,
    // Number of the gauge's compositions: one with everything, and one without each part.
    compositions: u32,
    // Drawn share of the layer behind the sky times that of the clear sky.
    behind_drawn: f32,
    // Luminance of the value 1 in the layer behind the sky, cd/m^2, and the share of the night floor that the layer
    // replaces.
    behind: vec2f,
    // Colour of the light of flashes, of luminance 1, and the number of sources.
    flash_color: vec3f,
    flash_count: u32,
    // Clouds that flashes light: height of their face above the camera, m; their cover; extinction of the haze in front
    // of them, 1/m; scattering coefficient of the air, 1/m.
    flash_plane: f32,
    flash_cover: f32,
    flash_haze: f32,
    flash_scattering: f32,
    flashes: array<FlashSource, MAX_FLASHES>,
    // rgb: share of direct light in all light on level ground, divided by the mean share of direct light that clouds
    // let through. w: that mean share.
    cloud_shadow: vec4f,
    // Size of the picture, pixels.
    picture: vec2f,
    // Share of the clouds that is drawn as a volume instead of a deck (src/plan), and the height of their base above
    // the camera, m.
    clouds_drawn: f32,
    clouds_over: f32,
    // Mean light of the clouds that may be drawn as a volume, cd/m^2, and their cover; 0 without such clouds.
    mean_cloud: vec4f,
    // Extinction of falling snow that drawn flakes replace, 1/m, and the distance up to which they replace it, m.
    flakes: vec2f,
    // Factor, a power of two, that scales light so that white is about 1 (frame/even.wgsl).
    even_scale: f32,
    // Two tables of the difference that bows make to the phase function of drops, 1/sr for each channel, by the angle
    // from the antisolar point (between/bow.wgsl).
    bows: array<vec4f, 320>,
}

// Linear Rec. 709 colour of light given at the planet's three wavelengths. Pure blues lie outside of Rec. 709; their
// negative channels are set to 0.
fn color_of(spectrum: vec3f) -> vec3f {
    let c = frame.color[0].xyz * spectrum.x + frame.color[1].xyz * spectrum.y + frame.color[2].xyz * spectrum.z;
    return not_negative(c);
}

@group(0) @binding(0) var<uniform> frame: FrameUniform;

// Normalised device coordinates of a position in the picture, where (0, 0) is the upper left corner.
fn frame_ndc(uv: vec2f) -> vec2f {
    return vec2f(uv.x * 2.0 - 1.0, (1.0 - uv.y * 2.0) * frame.y_sign);
}

// Drawn shares, as frame.drawn. The gauge (plan/gauge.wgsl) changes them to measure the importance of each part.
var<private> drawn: vec4f;

// Optical depth, up to the distance `range`, of the rain and snow that is drawn as single drops and flakes.
fn depth_of_drawn(range: f32) -> f32 {
    return frame.drops.x * min(range, frame.drops.y) + frame.flakes.x * min(range, frame.flakes.y);
}

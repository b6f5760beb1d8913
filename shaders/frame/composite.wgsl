// One pixel of the frame: sky behind, water on surfaces, air and fog between, tone on top. Host colour x T + L throughout.
//!include "common/fullscreen.wgsl"
//!include "common/tone.wgsl"
//!include "between/veil.wgsl"
//!include "sky/disc.wgsl"
//!include "ground/surface.wgsl"

override BACKGROUND: bool = true;
override SURFACE: bool = true;
override MEDIUM: bool = true;
override TONE: bool = true;
override PARTICLES: bool = false;

const SCENE_LINEAR: u32 = 0u;
const DISPLAY_SRGB: u32 = 2u;

// What stands behind the sky's own light, in the night floor's place: stars and the glow between them.
@group(0) @binding(11) var behind: texture_2d<f32>;

override STARS: bool = false;
// The discs of sun and moon: the host has their light otherwise where it asks for the sky alone.
override DISCS: bool = true;

// Its texel, which several samples of a pixel share.
var<private> behind_pixel: vec2i;

fn night_light() -> vec3f {
    if !STARS || frame.behind.y == 0.0 {
        return frame.night_floor;
    }
    let light = textureLoad(behind, behind_pixel, 0).rgb * frame.behind.x;
    return mix(frame.night_floor, light, frame.behind.y * drawn.z);
}

fn sky_behind(path: SkyPath, d: vec3f) -> vec3f {
    if (!CLEAR_SKY || DECK_CLOSED || drawn.z == 0.0) && d.z >= 0.0 {
        return mix(frame.night_floor, frame.deck * overcast_gradation(d.z), frame.deck_cover);
    }
    let spectrum = sky_radiance_on(path, d);
    let night = night_light();
    if d.z < 0.0 {
        return color_of(spectrum + ground_radiance_on(path, d)) * frame.medium_share + night;
    }
    // A disc takes nothing from the sky it stands in, though its red lies outside of Rec. 709.
    var clear = color_of(spectrum);
    if DISCS {
        clear += max(color_of(disc_radiance_on(path, d, frame.pixel_angle) * frame.direct_share), vec3f(0.0));
    }
    clear = clear * drawn.z + night;
    return mix(clear, frame.deck * overcast_gradation(d.z), frame.deck_cover);
}

// Display-linear value of scene luminance.
fn display(luminance: vec3f) -> vec3f {
    // Saturated spectra lie outside of Rec. 709 and have negative parts there.
    return tone_curve(frame.tone, max(luminance, vec3f(0.0)) * frame.exposure);
}

// What weather adds to a pixel. `range` along the ray and `plane` from the camera's plane are RANGE_SKY where the host
// drew nothing.
fn weather_over(ray: ViewRay, range: f32, plane: f32) -> Veil {
    let sky = range >= RANGE_SKY;
    var veil = Veil(vec3f(0.0), vec3f(1.0));
    // One path for sky and air: a driver that compiles both ways, and takes both, does its part once.
    let path = sky_path(ray.direction, range);
    if BACKGROUND && sky {
        veil = Veil(sky_behind(path, ray.direction), vec3f(0.0));
    } else if MEDIUM && !sky {
        veil = air_on(path, ray.direction);
    }
    if MEDIUM {
        veil = with_fog(ray, range, plane, veil);
    }
    return veil;
}

// Drops before everything (rain/drops.wgsl), on which the exposure is already.
@group(0) @binding(5) var drops: texture_2d<f32>;

fn with_drops(veil: Veil, pixel: vec2u) -> Veil {
    let layer = textureLoad(drops, vec2i(pixel), 0);
    // Blended halves may round beyond 1.
    let clear = max(1.0 - layer.a, 0.0);
    return Veil(veil.light * clear + layer.rgb / frame.exposure, veil.transmittance * clear);
}

// What the host says of the surface that a pixel shows, where it does: its class in red, and its normal.
@group(0) @binding(9) var host_classes: texture_2d<f32>;
@group(0) @binding(10) var host_normals: texture_2d<f32>;

override HAS_CLASSES: bool = false;
override HAS_NORMALS: bool = false;

fn host_surface(facing: Facing, pixel: vec2u) -> HostSurface {
    var surface = HostSurface(facing, 0u, vec4f(0.0));
    if HAS_CLASSES {
        surface.number = u32(textureLoad(host_classes, vec2i(pixel), 0).r * 255.0 + 0.5);
    }
    if HAS_NORMALS {
        surface.normal = given_normal(ground, textureLoad(host_normals, vec2i(pixel), 0).rgb);
    }
    return surface;
}

// The host's colour as luminance, or linear in the display's space.
fn linear_host(host: vec3f) -> vec3f {
    if frame.color_space == SCENE_LINEAR {
        return host * frame.cd_m2_per_unit;
    }
    return select(host, srgb_decode(host), frame.color_space == DISPLAY_SRGB);
}

fn compose(host: vec4f, range: f32, plane: f32, facing: Facing, mask: f32, ndc: vec2f, pixel: vec2u) -> vec4f {
    drawn = frame.drawn;
    behind_pixel = vec2i(pixel);
    let ray = view_ray(frame.depth, ndc);
    var veil = weather_over(ray, range, plane);
    if SURFACE && range < RANGE_SKY {
        let wet = wet_surface(linear_host(host.rgb), frame.color_space != SCENE_LINEAR, ray, range, host_surface(facing, pixel));
        veil.light += veil.transmittance * wet.light;
        veil.transmittance *= wet.transmittance;
    }
    if PARTICLES {
        veil = with_drops(veil, pixel);
    }
    return vec4f(mix(written(host.rgb, veil, pixel), host.rgb, mask), host.a);
}

fn written(host: vec3f, veil: Veil, pixel: vec2u) -> vec3f {
    var shown: vec3f;
    if frame.color_space == SCENE_LINEAR {
        let luminance = host * frame.cd_m2_per_unit * veil.transmittance + veil.light;
        if !TONE {
            return luminance / frame.cd_m2_per_unit;
        }
        shown = display(luminance);
    } else {
        let behind = select(host, srgb_decode(host), frame.color_space == DISPLAY_SRGB);
        shown = behind * veil.transmittance + display(veil.light);
    }
    let encoded = select(shown, srgb_encode(shown), frame.encode == 1u);
    return select(encoded, dither(encoded, frame.dither_step, pixel, frame.seed), frame.dither_step > 0.0);
}

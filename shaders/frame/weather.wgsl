// Weather's effect on a pixel: the sky behind, air and fog in front.
//!include "common/guarded.wgsl"
//!include "between/sky.wgsl"
//!include "between/veil.wgsl"
//!include "sky/disc.wgsl"

// Whether the stages BACKGROUND and MEDIUM are drawn.
override BACKGROUND: bool = true;
override MEDIUM: bool = true;

// Whether pixels in which the host drew nothing may lie above the level of the eye, and whether they may lie below.
override FAR_ABOVE: bool = true;
override FAR_BELOW: bool = true;
// Ratio of the optical depth of clouds to their delta-scaled optical depth, in which light scattered straight on counts
// as not scattered.
const CLOUD_STRAIGHT: f32 = 1.8;
// Whether to draw the discs of sun and moon. The cube map leaves them out, because the host gets their light in another
// way.
override DISCS: bool = true;

// Radiance of the planet's own ground under a cloud deck, with the air in front of it, cd/m^2. The deck lights it like
// an overcast sky: E = 7 pi / 9 L, with E the illuminance of level ground and L the zenith luminance (Moon and Spencer
// 1942). The deck also lights the air in front (air_on).
fn ground_under_deck(path: SkyPath) -> vec3f {
    let transmittance = exp(-path.depth);
    let ground = sky_view.air.ground_albedo * (7.0 / 9.0) * f32(path.ray.grounded);
    return frame.deck * mix(vec3f(overcast_gradation(0.0)), ground, transmittance);
}

// Discs of sun and moon behind clouds. The clouds' transmittance for an image of the disc is lower than their
// delta-scaled one, which includes light scattered straight on. Negative channels of a disc, whose red lies outside of
// Rec. 709, are set to 0, so that the disc takes no light from the sky around it.
fn disc_light(radiance: Radiance, sky: SkySample) -> vec3f {
    if !DISCS {
        return vec3f(0.0);
    }
    let through = select(1.0, pow(sky.clouds.a, CLOUD_STRAIGHT - 1.0), CLOUDS);
    return not_negative(color_of(radiance * (through * sky.disc)));
}

// Light from behind all that the host drew and behind the clouds, above the level of the eye.
fn behind_above(d: vec3f, sky: SkySample) -> vec3f {
    if !CLEAR_SKY || deck_hides_all() || drawn.z == 0.0 {
        return open_sky(d, vec3f(0.0), sky);
    }
    let disc = disc_light(disc_radiance_above(d, frame.pixel_angle), sky);
    return open_sky(d, color_of(sky_radiance_above(d)) * air_lit + disc, sky);
}

// Light as in `behind_above`, below the level of the eye: the planet's own ground with the air in front of it and, from
// high up, also the sky down to the horizon.
fn behind_below(path: SkyPath, d: vec3f, sky: SkySample) -> vec3f {
    if deck_hides_all() {
        return ground_under_deck(path) + night_light(sky);
    }
    let air = sky_radiance_on(path, d);
    var clear = color_of(air + ground_radiance_on(path, d)) * frame.medium_share;
    if CLOUD_SHAFTS {
        clear += color_of(air) * (air_lit - 1.0) * frame.medium_share;
    }
    clear += disc_light(disc_radiance_on(path, d, frame.pixel_angle), sky);
    return mix(clear, ground_under_deck(path), frame.deck_cover) + night_light(sky);
}

// Weather's effect on a pixel. `range` along the ray and `plane` from the camera's plane are RANGE_SKY where the host
// drew nothing.
fn weather_over(ray: ViewRay, range: f32, plane: f32, sky: SkySample) -> Veil {
    let is_sky = range >= RANGE_SKY;
    let above = FAR_ABOVE && (!FAR_BELOW || ray.direction.z >= 0.0);
    var veil = Veil(vec3f(0.0), vec3f(1.0));
    // One path serves ground and air: a driver that compiles and executes both branches then computes the path once.
    // The sky above the level of the eye needs no path.
    var path: SkyPath;
    if !(is_sky && above) {
        path = sky_path(ray.direction, range);
    }
    if BACKGROUND && is_sky {
        var behind = vec3f(0.0);
        if above {
            behind = behind_above(ray.direction, sky);
        } else {
            behind = behind_below(path, ray.direction, sky);
        }
        veil = Veil(before_sky(behind, ray.direction, sky), vec3f(0.0));
    } else if MEDIUM && !is_sky {
        veil = air_on(path, ray.direction);
    }
    if MEDIUM {
        veil = veil_before(ray, range, plane, veil, sky);
    }
    if FLASH && MEDIUM {
        veil.light += flash_before(ray, range, sky);
    }
    return veil;
}

// One pixel of the frame: sky behind, water on surfaces, air and fog between, tone on top. Host colour x T + L throughout.
//!include "common/fullscreen.wgsl"
//!include "frame/color_space.wgsl"
//!include "between/veil.wgsl"
//!include "sky/disc.wgsl"
//!include "frame/on_surfaces.wgsl"
//!include "lightning/glow.wgsl"

override BACKGROUND: bool = true;
override MEDIUM: bool = true;
override TONE: bool = true;
override PARTICLES: bool = false;

// Layers of the sky. The last is what stands behind the sky's own light, in the night floor's place: stars and the glow between them.
// With clouds there are two before it (clouds/): their light with the exposure on it, and what they let through; log2 of the distances
// between which they stand, m, with the share of direct light that they let through to what the host drew.
@group(0) @binding(11) var sky_layers: texture_2d_array<f32>;

override CLOUDS: bool = false;
// They cast shadows on what the host drew.
override CLOUD_SHADOWS: bool = false;
// A closed layer above them all is drawn as a deck.
override DECK_BEHIND: bool = false;
// Optical depth of clouds over what of it is left when what they scatter straight on counts as not scattered.
const CLOUD_STRAIGHT: f32 = 1.8;
override STARS: bool = false;
// The discs of sun and moon: the host has their light otherwise where it asks for the sky alone.
override DISCS: bool = true;

// The texel of these layers, which several samples of a pixel share, and whether there is one: a cube map and the gauge have none, and
// see a deck in the clouds' place.
var<private> layer_pixel: vec2i;
var<private> in_picture: bool;
// Share of that layer in the night floor's place.
var<private> behind_share: f32;

fn has_clouds() -> bool {
    return CLOUDS && in_picture;
}

// How far the sky is a deck.
fn deck_share() -> f32 {
    return select(frame.deck_cover, select(0.0, 1.0, DECK_BEHIND), has_clouds());
}

// A deck hides all that is behind it.
fn deck_hides_all() -> bool {
    return DECK_CLOSED && (DECK_BEHIND || !has_clouds());
}

fn night_light() -> vec3f {
    if !STARS {
        return frame.night_floor;
    }
    let light = textureLoad(sky_layers, layer_pixel, select(0, 2, CLOUDS), 0).rgb * frame.behind.x;
    return mix(frame.night_floor, light, behind_share);
}

// The planet's own ground as far as it lies under a deck, whose light on it is that of an overcast sky: 7 pi / 9 of its zenith's
// luminance (Moon and Spencer 1942). The air before it is lit by the deck too (air_on).
fn ground_under_deck(path: SkyPath) -> vec3f {
    let transmittance = exp(-path.depth);
    let ground = sky_view.air.ground_albedo * (7.0 / 9.0) * f32(path.ray.grounded);
    return frame.deck * mix(vec3f(overcast_gradation(0.0)), ground, transmittance);
}

// The discs of sun and moon behind clouds. A disc takes nothing from the sky it stands in, though its red lies outside of Rec. 709.
fn disc_light(path: SkyPath, d: vec3f) -> vec3f {
    if !DISCS {
        return vec3f(0.0);
    }
    let through = select(frame.direct_share, cloud_disc(), has_clouds());
    return max(color_of(disc_radiance_on(path, d, frame.pixel_angle) * through), vec3f(0.0));
}

fn sky_behind(path: SkyPath, d: vec3f) -> vec3f {
    let deck_cover = deck_share();
    if (!CLEAR_SKY || deck_hides_all() || drawn.z == 0.0) && d.z >= 0.0 {
        return mix(frame.night_floor, frame.deck * overcast_gradation(d.z), deck_cover);
    }
    let night = night_light();
    if deck_hides_all() {
        return ground_under_deck(path) + night;
    }
    let spectrum = sky_radiance_on(path, d);
    if d.z < 0.0 {
        let clear = color_of(spectrum + ground_radiance_on(path, d)) * frame.medium_share;
        return mix(clear, ground_under_deck(path), frame.deck_cover) + night;
    }
    let clear = (color_of(spectrum) + disc_light(path, d)) * drawn.z + night;
    return mix(clear, frame.deck * overcast_gradation(d.z), deck_cover);
}

// Share of a disc's light that gets through clouds straight, over what they let through with all that they scatter straight on.
fn cloud_disc() -> f32 {
    let left = textureLoad(sky_layers, layer_pixel, 0, 0).a;
    return pow(left, CLOUD_STRAIGHT - 1.0);
}

// Clouds before what is behind them; as many of them as stand before something at this range.
fn with_clouds(behind: Veil, range: f32) -> Veil {
    if !has_clouds() {
        return behind;
    }
    var layer = textureLoad(sky_layers, layer_pixel, 0, 0);
    if range < RANGE_SKY {
        let reach = exp2(textureLoad(sky_layers, layer_pixel, 1, 0).rg);
        let share = clamp((range - reach.x) / max(reach.y - reach.x, 1.0), 0.0, 1.0);
        layer = mix(vec4f(0.0, 0.0, 0.0, 1.0), layer, share);
    }
    return Veil(behind.light * layer.a + layer.rgb / frame.exposure, behind.transmittance * layer.a);
}

// Share of what is behind that clouds hide.
fn cover_along() -> f32 {
    if has_clouds() {
        return 1.0 - textureLoad(sky_layers, layer_pixel, 0, 0).a * (1.0 - deck_share());
    }
    return frame.flash_cover;
}

// What the shadow of clouds leaves of the light on what the host drew, of that on the mean over places, in which the host lit it.
fn under_clouds(range: f32) -> vec3f {
    if !CLOUD_SHADOWS || range >= RANGE_SKY {
        return vec3f(1.0);
    }
    let share = textureLoad(sky_layers, layer_pixel, 1, 0).b;
    return 1.0 + frame.cloud_shadow.rgb * (share - frame.cloud_shadow.w);
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
    veil = with_clouds(veil, range);
    if FLASH && BACKGROUND && sky {
        veil.light += flash_on_clouds(ray.direction) * cover_along();
    }
    if MEDIUM {
        veil = with_fog(ray, range, plane, veil);
    }
    if FLASH && MEDIUM {
        veil.light += flash_in_air(ray, range);
    }
    return veil;
}

// Drops before everything (rain/drops.wgsl), on which the exposure is already.
@group(0) @binding(5) var drops: texture_2d<f32>;

fn with_drops(veil: Veil, pixel: vec2i) -> Veil {
    let layer = textureLoad(drops, pixel, 0);
    // Blended halves may round beyond 1.
    let clear = max(1.0 - layer.a, 0.0);
    return Veil(veil.light * clear + layer.rgb / frame.exposure, veil.transmittance * clear);
}

fn compose(host: vec4f, seen: Seen) -> vec4f {
    drawn = frame.drawn;
    behind_share = frame.behind_drawn;
    layer_pixel = seen.pixel;
    in_picture = true;
    let ray = view_ray(frame.depth, seen.ndc);
    var veil = weather_over(ray, seen.range, seen.plane);
    veil = on_surface(veil, linear_host(host.rgb), ray, seen);
    veil.transmittance *= under_clouds(seen.range);
    if PARTICLES {
        veil = with_drops(veil, seen.pixel);
    }
    return vec4f(mix(written(host.rgb, veil, vec2u(seen.pixel)), host.rgb, seen.mask), host.a);
}

fn written(host: vec3f, veil: Veil, pixel: vec2u) -> vec3f {
    // Of a host with luminances all is shown by the tone curve, of one with a display's colours only what weather adds.
    let behind = linear_host(host) * veil.transmittance;
    var light = veil.light;
    var shown = vec3f(0.0);
    if is_space(SCENE_LINEAR) {
        light += behind;
        if !TONE {
            return light / frame.cd_m2_per_unit;
        }
    } else {
        shown = behind;
    }
    shown += display(light);
    if ENCODES && frame.encode == 1u {
        shown = srgb_encode(shown);
    }
    if DITHERS && frame.dither_step > 0.0 {
        shown = dither(shown, frame.dither_step, pixel, frame.seed);
    }
    return shown;
}

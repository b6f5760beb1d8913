// Clouds in the sky, and stars behind the sky's own light: in a pixel of the picture, or in any direction from the
// camera.
//!include "between/sky_sample_bare.wgsl"
//!include "between/flash.wgsl"
//!include "between/glow.wgsl"
//!include "common/octahedron.wgsl"

// Layers of the sky. The last layer has the stars and the glow between them, which stand behind the sky's own light and
// replace the night floor. With clouds there are two layers before it (clouds/). The first has the clouds' radiance
// times exposure and their transmittance. The second has log2 of the distances between which the clouds stand, m, the
// share of direct light at the surface that the host drew, and the share of direct light in the air in front of that
// surface, less its mean over all places. Below the picture, the first layer has the panorama (clouds/round.wgsl) and
// the second the clouds' glow (between/glow.wgsl).
@group(0) @binding(11) var sky_layers: texture_2d_array<f32>;

override CLOUDS: bool = false;
// Whether a closed layer above all clouds is drawn as a deck.
override DECK_BEHIND: bool = false;
// Whether clouds leave shafts of light in the air.
override CLOUD_SHAFTS: bool = false;
// Whether lamps or flashes light the clouds.
override CLOUD_GLOW: bool = false;
// Whether the last layer has stars and glow.
override STARS: bool = false;

// Rate, per octave, at which a texel of the glow loses weight as the distance of its clouds differs from that of the
// pixel's clouds.
const GLOW_ALIKE: f32 = 12.0;
// Side of the panorama, texels.
const ROUND_SIDE: f32 = 96.0;

// No clouds: no radiance, transmittance 1.
const NO_CLOUDS: vec4f = vec4f(0.0, 0.0, 0.0, 1.0);

// Replaces the share `frame.clouds_drawn` of the deck by `clouds`, which are drawn as a volume.
fn sky_sample_with(clouds: vec4f) -> SkySample {
    var sky = bare_sky_sample();
    if CLOUDS {
        sky.clouds = mix(sky.clouds, clouds, frame.clouds_drawn);
        sky.deck = mix(sky.deck, select(0.0, 1.0, DECK_BEHIND), frame.clouds_drawn);
        sky.disc = mix(sky.disc, 1.0, frame.clouds_drawn);
    }
    return sky;
}

// Glow of the clouds in a pixel. `reach` is log2 of their distance, m. Of the texels around the pixel, those whose
// clouds have a similar distance have most weight.
fn glow_in(pixel: vec2i, reach: f32) -> vec3f {
    let size = glow_size(frame.picture);
    let at = (vec2f(pixel) + 0.5) / frame.picture * size - 0.5;
    let first = floor(at);
    let part = at - first;
    var sum = vec4f(0.0);
    for (var k = 0u; k < 4u; k++) {
        let to = vec2f(f32(k & 1u), f32(k >> 1u));
        let texel = clamp(first + to, vec2f(0.0), size - 1.0) + vec2f(0.0, frame.picture.y);
        let glow = textureLoad(sky_layers, vec2i(texel), 1, 0);
        let near = mix(1.0 - part, part, to);
        let alike = select(1e-3 + exp(-abs(glow.a - reach) * GLOW_ALIKE), 0.0, glow.a == 0.0);
        sum += vec4f(glow.rgb, 1.0) * (near.x * near.y * alike);
    }
    return sum.rgb / max(sum.a, 1e-9);
}

// Sky in a pixel of the picture, or in one of its samples, in front of a surface at this range.
fn sky_sample_in(pixel: vec2i, range: f32) -> SkySample {
    var clouds = NO_CLOUDS;
    if CLOUDS {
        clouds = textureLoad(sky_layers, pixel, 0, 0);
    }
    var sky = sky_sample_with(clouds);
    if CLOUDS && (FLASH || CLOUD_SHAFTS || CLOUD_GLOW || range < RANGE_SKY) {
        let reach = textureLoad(sky_layers, pixel, 1, 0);
        sky.reach = reach.rgb;
        sky.shafts = reach.a * frame.clouds_drawn;
        sky.reach.z = mix(frame.cloud_shadow.w, sky.reach.z, frame.clouds_drawn);
    }
    if CLOUD_GLOW {
        sky.glow = glow_in(pixel, 0.5 * (sky.reach.x + sky.reach.y));
        sky.has_glow = true;
    }
    if STARS {
        sky.behind = textureLoad(sky_layers, pixel, select(0, 2, CLOUDS), 0).rgb * frame.behind.x;
    }
    return sky;
}

// Sky in a direction inside or outside the picture: clouds without their distance, and no stars.
fn sky_sample_toward(d: vec3f) -> SkySample {
    var clouds = NO_CLOUDS;
    if CLOUDS {
        let size = vec2f(textureDimensions(sky_layers));
        let at = vec2f(0.5, size.y - ROUND_SIDE + 0.5) + octahedron_place(d) * (ROUND_SIDE - 1.0);
        clouds = textureSampleLevel(sky_layers, sky_sampler, at / size, 0, 0.0);
    }
    return sky_sample_with(clouds);
}

// Whether a deck hides all that is behind it.
fn deck_hides_all() -> bool {
    return DECK_CLOSED && (DECK_BEHIND || !CLOUDS);
}

// Lays in front of `behind` the share of the clouds that is nearer than `range`.
fn with_clouds(behind: Veil, sky: SkySample, range: f32) -> Veil {
    if !CLOUDS {
        return behind;
    }
    var clouds = sky.clouds;
    if CLOUD_GLOW {
        clouds += vec4f(sky.glow * (1.0 - clouds.a), 0.0);
    }
    if range < RANGE_SKY {
        let reach = exp2(sky.reach.xy);
        let share = clamp((range - reach.x) / max(reach.y - reach.x, 1.0), 0.0, 1.0);
        clouds = mix(NO_CLOUDS, clouds, share);
    }
    return Veil(behind.light * clouds.a + clouds.rgb / frame.exposure, behind.transmittance * clouds.a);
}

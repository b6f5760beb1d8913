// What hangs in the sky: clouds, and stars behind the sky's own light; in a pixel of the picture, or in any direction
// from the camera.
//!include "between/hung_bare.wgsl"
//!include "between/flash.wgsl"
//!include "between/glow.wgsl"
//!include "common/octahedron.wgsl"

// Layers of the sky. The last is what stands behind the sky's own light, in the night floor's place: stars and the glow
// between them. With clouds there are two before it (clouds/): their light with the exposure on it, and what they let
// through; log2 of the distances between which they stand, m, the share of direct light that they let through to what
// the host drew, and the difference of that in the air before it from the mean. Below the first one's picture lie the
// clouds of all directions (clouds/round.wgsl), below the second one's their glow (between/glow.wgsl).
@group(0) @binding(11) var sky_layers: texture_2d_array<f32>;

override CLOUDS: bool = false;
// A closed layer above them all is drawn as a deck.
override DECK_BEHIND: bool = false;
// Clouds leave shafts of light in the air.
override CLOUD_SHAFTS: bool = false;
// Lamps or flashes light them.
override CLOUD_GLOW: bool = false;
override STARS: bool = false;

// How fast a texel of the glow counts less with the distance of its clouds from a pixel's, in octaves.
const GLOW_ALIKE: f32 = 12.0;
// Texels along a side of the clouds of all directions.
const ROUND_SIDE: f32 = 96.0;

// Clouds where there are none: no light, and all let through.
const NO_CLOUDS: vec4f = vec4f(0.0, 0.0, 0.0, 1.0);

// With clouds drawn as a volume in the deck's place, as far as they are.
fn hung_with(clouds: vec4f) -> Hung {
    var hung = hung_bare();
    if CLOUDS {
        hung.clouds = mix(hung.clouds, clouds, frame.clouds_drawn);
        hung.deck = mix(hung.deck, select(0.0, 1.0, DECK_BEHIND), frame.clouds_drawn);
        hung.disc = mix(hung.disc, 1.0, frame.clouds_drawn);
    }
    return hung;
}

// The glow of clouds in a pixel whose clouds stand at this distance, log2 of m: of the texels about it those count
// whose clouds do too.
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

// In a pixel of the picture, or one of its samples, where something is seen at this range.
fn hung_in(pixel: vec2i, range: f32) -> Hung {
    var clouds = NO_CLOUDS;
    if CLOUDS {
        clouds = textureLoad(sky_layers, pixel, 0, 0);
    }
    var hung = hung_with(clouds);
    if CLOUDS && (FLASH || CLOUD_SHAFTS || CLOUD_GLOW || range < RANGE_SKY) {
        let reach = textureLoad(sky_layers, pixel, 1, 0);
        hung.reach = reach.rgb;
        hung.shafts = reach.a * frame.clouds_drawn;
        hung.reach.z = mix(frame.cloud_shadow.w, hung.reach.z, frame.clouds_drawn);
    }
    if CLOUD_GLOW {
        hung.glow = glow_in(pixel, 0.5 * (hung.reach.x + hung.reach.y));
        hung.has_glow = true;
    }
    if STARS {
        hung.behind = textureLoad(sky_layers, pixel, select(0, 2, CLOUDS), 0).rgb * frame.behind.x;
    }
    return hung;
}

// In a direction, in or outside of the picture: clouds without their distance, and no stars.
fn hung_toward(d: vec3f) -> Hung {
    var clouds = NO_CLOUDS;
    if CLOUDS {
        let size = vec2f(textureDimensions(sky_layers));
        let at = vec2f(0.5, size.y - ROUND_SIDE + 0.5) + octahedron_place(d) * (ROUND_SIDE - 1.0);
        clouds = textureSampleLevel(sky_layers, sky_sampler, at / size, 0, 0.0);
    }
    return hung_with(clouds);
}

// A deck hides all that is behind it.
fn deck_hides_all() -> bool {
    return DECK_CLOSED && (DECK_BEHIND || !CLOUDS);
}

// Clouds before something at this range; as many of them as stand before it.
fn with_clouds(behind: Veil, hung: Hung, range: f32) -> Veil {
    if !CLOUDS {
        return behind;
    }
    var clouds = hung.clouds;
    if CLOUD_GLOW {
        clouds += vec4f(hung.glow * (1.0 - clouds.a), 0.0);
    }
    if range < RANGE_SKY {
        let reach = exp2(hung.reach.xy);
        let share = clamp((range - reach.x) / max(reach.y - reach.x, 1.0), 0.0, 1.0);
        clouds = mix(NO_CLOUDS, clouds, share);
    }
    return Veil(behind.light * clouds.a + clouds.rgb / frame.exposure, behind.transmittance * clouds.a);
}

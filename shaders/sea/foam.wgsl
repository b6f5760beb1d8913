// Foam of the sea: the share of a pixel that foam covers, and how white it makes the pixel. src/sea/foam.rs has the law
// of the share, src/sea/lace.rs the pattern by which a share is laid out.
//!include "sea/surface.wgsl"

// Reflectance of dense foam (Koepke 1984).
const FOAM_WHITE: f32 = 0.55;
// Light of foam as a share of the light of dense foam, in the mean over the area of foam: for waves that break now, and
// for the foam that they left. With a quarter of the first and three quarters of the second the mean is 0.4, which is
// Koepke's mean over all ages, 0.22, divided by 0.55.
const FOAM_FRESH_MEAN: f32 = 0.8;
const FOAM_LEFT_MEAN: f32 = 0.26667;
// Least area that a unit of the surface at rest keeps where it is compressed.
const SEA_LEAST_AREA: f32 = 0.1;
// Least share of a pixel under foam with which the foam is drawn.
const FOAM_LEAST: f32 = 1e-3;

// Lengths of the two patterns, m, and cosine and sine of the turn of the coarse one.
const LACE_FINE: f32 = 6.4;
const LACE_COARSE: f32 = 17.3;
const LACE_TURN: vec2f = vec2f(0.8, 0.6);
// Length and width of the pattern of streaks, m.
const STREAK_LONG: f32 = 120.0;
const STREAK_WIDE: f32 = 12.0;
// Binary logarithm of the texels per metre of each pattern; for streaks, across them.
const LACE_FINE_OCTAVES: f32 = 5.321928;
const LACE_COARSE_OCTAVES: f32 = 3.887287;
const STREAK_OCTAVES: f32 = 4.415037;
// Mip level of streaks seen from near, which have no fine detail, and the levels between which they fade.
const STREAK_LEAST_MIP: f32 = 2.5;
const STREAK_FADES: vec2f = vec2f(3.5, 5.5);
// Mip levels between which a pattern fades: from the first on its threads are no wider than a texel, and look-ups
// between texels flatten them.
const LACE_FADES: vec2f = vec2f(1.5, 4.0);

// Share under foam of waves that break now, where the compression is beyond the threshold. The compression is the part
// that the pixel shows, plus a normal distribution for the part that it does not show.
fn breaking_share(shown: SeaSlopes) -> f32 {
    let area = compressed_area(shown.compression, sqrt(sea.compression * shown.hidden));
    return min(area / max(1.0 - shown.compression, SEA_LEAST_AREA), 1.0);
}

// Density of foam that a pattern of evenly distributed ranks gathers: 1 in the mean, at most 4.
fn gathered_at(rank: f32) -> f32 {
    let low = 1.0 - rank;
    return 4.0 * low * low * low;
}

// Factor, 1 in the mean, by which foam is gathered in patches and streaks.
fn streak_factor(at: vec2f, octaves: f32) -> f32 {
    if sea.foam.gathered == 0.0 {
        return 1.0;
    }
    let mip = max(octaves + STREAK_OCTAVES, STREAK_LEAST_MIP);
    if mip >= STREAK_FADES.y {
        return 1.0;
    }
    let size = vec2f(1.0 / STREAK_LONG, 1.0 / STREAK_WIDE);
    var density = 0.0;
    for (var i = 0u; i < 2u; i++) {
        let weight = select(1.0 - sea.foam.second, sea.foam.second, i == 1u);
        if weight > 0.0 {
            let streaks = sea.foam.streaks[i];
            let place = streaks.xy + to_tile(streaks.zw, at) * size;
            density += weight * gathered_at(textureSampleLevel(sea_lace, sea_repeating, place, mip).r);
        }
    }
    let gathered = sea.foam.gathered * (1.0 - smoothstep(STREAK_FADES.x, STREAK_FADES.y, mip));
    return mix(1.0, density, gathered);
}

// Rank of a place in the pattern: foam that covers a share of the water covers the places whose rank is below the
// share. The rank is the product of two ranks, made evenly distributed again, so that neither pattern shows how it
// repeats.
fn lace_rank(at: vec2f, octaves: f32) -> f32 {
    let fine = sea.foam.lace.xy + at / LACE_FINE;
    let coarse = sea.foam.lace.zw + to_tile(LACE_TURN, at) / LACE_COARSE;
    let a = textureSampleLevel(sea_lace, sea_repeating, fine, max(octaves + LACE_FINE_OCTAVES, 0.0)).r;
    let b = textureSampleLevel(sea_lace, sea_repeating, coarse, max(octaves + LACE_COARSE_OCTAVES, 0.0)).r;
    let both = max(a * b, 1e-6);
    return both * (1.0 - log(both));
}

// Foam of a pixel.
struct FoamCover {
    // Share of the pixel that foam covers.
    share: f32,
    // How much of the light of dense foam the pixel has.
    white: f32,
}

// Foam at the place at rest `at`. `left` and `wake` are the shares under foam that earlier waves and hulls left.
fn foam_cover(at: vec2f, shown: SeaSlopes, left: f32, wake: f32) -> FoamCover {
    let has_whitecaps = sea.foam_from < SEA_NO_FOAM;
    let breaking = select(0.0, breaking_share(shown), has_whitecaps);
    if breaking + left + wake < FOAM_LEAST {
        return FoamCover(breaking + left + wake, 0.0);
    }
    let share = min(breaking + left * streak_factor(at, shown.octaves) + wake, 1.0);
    if share < FOAM_LEAST {
        return FoamCover(share, 0.0);
    }
    let fresh = min(breaking / share, 1.0);
    let mean = mix(FOAM_LEFT_MEAN, FOAM_FRESH_MEAN, fresh);
    let faded = smoothstep(LACE_FADES.x, LACE_FADES.y, shown.octaves + LACE_FINE_OCTAVES);
    if faded >= 1.0 {
        return FoamCover(share, mean * share);
    }
    // Foam thins towards its edges, by a power with which its mean thickness over the covered share is `mean`.
    let thickness = clamp(1.0 - lace_rank(at, shown.octaves) / share, 0.0, 1.0);
    return FoamCover(share, mix(pow(thickness, 1.0 / mean - 1.0), mean * share, faded));
}

// Finds the cells of the coarse grid in which the weather is even: linear interpolation between the four texels is
// within a thousandth of the curves through these texels and their neighbours. Output: log2 of the least and the
// greatest range of the four texels, m; for other cells the least is greater than the greatest.
//!include "common/fullscreen.wgsl"
//!include "frame/even.wgsl"

@group(0) @binding(0) var even_weather: texture_2d_array<f32>;

// Light that is added to a texel's light before the limit is computed from the sum: 1/200 of white.
const LEAST_LIGHT: f32 = 0.005 * EVEN_WHITE;
// Limit of the interpolation's error, as a share of light + LEAST_LIGHT; for the transmittance, as an absolute error.
const MOST_ERROR: f32 = 1e-3;

// Findings about four texels in a row.
struct Row {
    // Error of linear interpolation between the middle two texels, divided by the limit.
    bend: f32,
    // Least and greatest range, log2 of m.
    reach: vec2f,
    // Above 0 next to a disc of sun or moon, or where the light is too great for the grid.
    disc: f32,
}

// Both layers of a texel of the grid. Outside the grid, those of the nearest texel.
fn texel(at: vec2i) -> array<vec4f, 2> {
    let last = vec2i(textureDimensions(even_weather)) - 1;
    let p = clamp(at, vec2i(0), last);
    return array(textureLoad(even_weather, p, 0, 0), textureLoad(even_weather, p, 1, 0));
}

// Reads four texels in a row in the direction `along`, from the one before `at`.
fn row(at: vec2i, along: vec2i) -> Row {
    let a = texel(at - along);
    let b = texel(at);
    let c = texel(at + along);
    let d = texel(at + 2 * along);
    // Error of linear interpolation between the middle two texels: |a - 2 b + c| / 8 or |b - 2 c + d| / 8, whichever is
    // greater. At a step in the light the two second differences have opposite signs and would cancel each other.
    let bent = max(abs(a[0].rgb - 2.0 * b[0].rgb + c[0].rgb), abs(b[0].rgb - 2.0 * c[0].rgb + d[0].rgb)) / 8.0;
    let dimmed = max(abs(a[1].rgb - 2.0 * b[1].rgb + c[1].rgb), abs(b[1].rgb - 2.0 * c[1].rgb + d[1].rgb)) / 8.0;
    // If the ranges of the middle two texels differ, a pixel between the texels may have any range between the two
    // ranges, and the weather of that range.
    let apart = select(0.0, 0.5, abs(b[0].a - c[0].a) > 0.5);
    let light = max(bent, apart * abs(b[0].rgb - c[0].rgb));
    let through = max(dimmed, apart * abs(b[1].rgb - c[1].rgb));
    let allowed = MOST_ERROR * (max(b[0].rgb, c[0].rgb) + LEAST_LIGHT);
    let bends = max(light / allowed, through / MOST_ERROR);
    let reach = vec2f(min(b[0].a, c[0].a), max(b[0].a, c[0].a));
    let is_too_light = any(max(b[0].rgb, c[0].rgb) >= vec3f(0.99 * EVEN_MOST));
    return Row(max(max(bends.x, bends.y), bends.z), reach, max(max(b[1].a, c[1].a), f32(is_too_light)));
}

@fragment
fn even_cells(in: FullscreenVarying) -> @location(0) vec2f {
    let cell = vec2i(in.position.xy);
    let rows = array(row(cell, vec2i(1, 0)), row(cell + vec2i(0, 1), vec2i(1, 0)));
    let columns = array(row(cell, vec2i(0, 1)), row(cell + vec2i(1, 0), vec2i(0, 1)));
    let bend = max(rows[0].bend, rows[1].bend) + max(columns[0].bend, columns[1].bend);
    // A NaN is not even.
    if !(bend <= 1.0) || rows[0].disc + rows[1].disc > 0.0 {
        return vec2f(1.0, -1.0) * 1000.0;
    }
    return vec2f(min(rows[0].reach.x, rows[1].reach.x), max(rows[0].reach.y, rows[1].reach.y));
}

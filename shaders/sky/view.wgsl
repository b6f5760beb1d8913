//!include "sky/maps.wgsl"
// Parametrisation of directions and distances in an observer's tables. The frame is the observer's: z up. The azimuth
// is counted from the light and mirrored into [0, pi], so that there is no seam.
//
// Zenith angles are stored as q = sin(angle/2), which needs no arc cosine. The parts above and below the horizon are
// separate, each dense at the horizon. Seen from space the upper part ends at the edge of the air.

// Computed in f64 on the CPU.
struct SkyEdges {
    // sin(angle/2) of the horizon and of the upper end of the air, and the reciprocals of the sizes of both parts.
    horizon: f32,
    top: f32,
    above_scale: f32,
    below_scale: f32,
}

fn half_sine(mu: Cosine) -> f32 {
    return sqrt(max(0.5 - 0.5 * mu, 0.0));
}

// Zenith cosine at coordinate v of the part above or below the horizon.
fn view_mu(edges: SkyEdges, v: f32, below: bool) -> Cosine {
    let q = edges.horizon + v * v * select(-1.0 / edges.above_scale, 1.0 / edges.below_scale, below);
    return clamp(1.0 - 2.0 * q * q, -1.0, 1.0);
}

// Coordinate v of a direction. It is negative below the horizon.
fn view_place(edges: SkyEdges, mu: Cosine) -> f32 {
    let over = edges.horizon - half_sine(mu);
    let v = sqrt(min(abs(over) * select(edges.below_scale, edges.above_scale, over >= 0.0), 1.0));
    return select(-v, v, over >= 0.0);
}

// Row, in texels, in a table whose upper part has `above` rows and whose lower part has `below` rows.
fn view_row(v: f32, above: u32, below: u32) -> f32 {
    return 0.5 + select(f32(above) - v * f32(below - 1u), v * f32(above - 1u), v >= 0.0);
}

// Distance along a ray in the volume: w^2 times the length of the ray in the air.
fn slice_distance(w: f32, len: Length) -> Length {
    return w * w * len;
}

fn slice_of(distance: Length, len: Length) -> f32 {
    return sqrt(clamp(distance / max(len, 1e-3), 0.0, 1.0));
}

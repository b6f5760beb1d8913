//! Shape of clouds seen from straight above: fractal dimension, numbers by size, and the direction of edges. The input
//! is square pictures that say for each pixel whether there is cloud. Lab, probe and tests share these estimators.
//!
//! A cloud is a set of cloudy pixels that touch along edges. Its perimeter counts the edges between its pixels and
//! clear ones. A cloud at the picture's border is cut: part of it lies outside. Leaving such clouds out would lose the
//! large ones, and taking them as they are would make them too small. As in DeWitt and Garrett (2024, *Finite domains
//! cause bias in measured and modeled distributions of cloud sizes*), distributions of sizes count cut clouds by what
//! is seen of them, and end where more than half of the clouds of a size are cut. The fractal dimension leaves cut
//! clouds out.

mod edges;
mod mask;
mod sizes;

pub use edges::{EdgeDirections, edge_directions};
pub use mask::{Cloud, CloudMask, clouds_of};
pub use sizes::{BrokenLaw, SizeCount, broken_law, exponent, fractal_dimension, number_by_diameter};

/// Least area of a cloud that counts in distributions, pixels: below, the square pixels make a cloud's shape.
pub const LEAST_PIXELS: f64 = 10.0;

/// Statistics of the clouds of several masks. `None` where too few clouds have been found.
#[derive(Clone, Debug)]
pub struct CloudShape {
    /// Share of the pixels that is cloud, 0 to 1.
    pub cover: f64,
    /// Number of clouds of at least [`LEAST_PIXELS`].
    pub count: usize,
    /// Fractal dimension of single clouds: perimeter as a power of the root of area, holes filled.
    pub dimension: Option<f64>,
    /// Exponent b of the perimeters p, whose number in equal steps of log p falls as p^-b.
    pub perimeter_exponent: Option<f64>,
    /// Exponent of the areas, defined likewise.
    pub area_exponent: Option<f64>,
    /// Exponent of the areas of 3 km^2 and more.
    pub large_area_exponent: Option<f64>,
    /// Directions of the edges.
    pub edges: EdgeDirections,
    /// Number of clouds by diameter of the circle of equal area.
    pub numbers: Vec<SizeCount>,
    /// Power laws of those numbers below and above a break.
    pub law: Option<BrokenLaw>,
}

/// Measures the clouds of several masks of equal size, whose pixels have sides of `pixel_m`.
pub fn measure(masks: &[CloudMask], pixel_m: f64) -> CloudShape {
    let clouds: Vec<Cloud> = masks.iter().flat_map(|mask| clouds_of(mask).0).collect();
    let side = masks.first().map_or(0, CloudMask::side) as f64;
    let perimeters: Vec<(f64, bool)> = clouds.iter().map(|c| (c.perimeter as f64, c.is_cut)).collect();
    let areas: Vec<(f64, bool)> = clouds.iter().map(|c| (c.pixels as f64, c.is_cut)).collect();
    // The ends of the bins are those of the package objscale, against which these numbers are checked.
    let long = (0.1 * side * side).max(4.0 * side);
    let large = 3e6 / (pixel_m * pixel_m);
    let numbers = number_by_diameter(&areas, pixel_m, masks.len() as f64 * (side * pixel_m / 1e3).powi(2));
    CloudShape {
        cover: masks.iter().map(CloudMask::cover).sum::<f64>() / masks.len().max(1) as f64,
        count: clouds.iter().filter(|c| c.pixels as f64 >= LEAST_PIXELS).count(),
        dimension: fractal_dimension(masks),
        perimeter_exponent: exponent(&perimeters, [4.0 * LEAST_PIXELS.sqrt(), long]),
        area_exponent: exponent(&areas, [LEAST_PIXELS, side * side]),
        large_area_exponent: exponent(&areas, [large.max(LEAST_PIXELS), side * side]),
        edges: edge_directions(masks),
        law: broken_law(&numbers),
        numbers,
    }
}

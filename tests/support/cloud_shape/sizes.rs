//! Power laws of the sizes of clouds.

use super::{
    LEAST_PIXELS,
    mask::{CloudMask, clouds_of},
};

/// Number of bins of a distribution and of the fit of the fractal dimension.
const BINS: usize = 30;
/// Least number of clouds of a bin that counts in an exponent.
const LEAST_COUNT: f64 = 30.0;
/// Number of successive bins, most of whose clouds are cut, at which a distribution ends.
const CUT_BINS: usize = 3;
/// Least root of area of a cloud that counts in the fractal dimension, pixels.
const LEAST_ROOT: f64 = 3.0;

/// Number of clouds of about one diameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeCount {
    /// Middle of the bin on a logarithmic scale, m.
    pub diameter_m: f64,
    /// Number of clouds found.
    pub count: usize,
    /// Number of clouds per km^2 of ground and per km of diameter.
    pub per_km2_km: f64,
}

/// Two power laws that meet at a break.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrokenLaw {
    /// Exponent below the break.
    pub below: f64,
    /// Diameter of the break, m.
    pub break_m: f64,
    /// Exponent above the break.
    pub above: f64,
}

/// Counts in equal bins of the decimal logarithm.
struct Bins {
    /// Logarithm at which the first bin begins.
    first: f64,
    /// Width of a bin.
    width: f64,
    /// Numbers of all clouds, and of those that are cut.
    counts: Vec<[usize; 2]>,
}

impl Bins {
    /// Counts sizes, each with whether the cloud is cut. Sizes outside the bins are left out.
    fn new(sizes: &[(f64, bool)], first: f64, width: f64, count: usize) -> Self {
        let mut counts = vec![[0; 2]; count];
        for (size, is_cut) in sizes.iter().filter(|(size, _)| *size > 0.0) {
            let place = (size.log10() - first) / width;
            if place >= 0.0 && place < count as f64 {
                counts[place as usize][0] += 1;
                counts[place as usize][1] += usize::from(*is_cut);
            }
        }
        Self { first, width, counts }
    }

    /// Returns the middle of a bin, as a logarithm.
    fn middle(&self, bin: usize) -> f64 {
        self.first + (bin as f64 + 0.5) * self.width
    }

    /// Returns the number of bins before the first of several in a row of which more than half of the clouds are cut.
    fn end(&self) -> usize {
        let mostly_cut = |bins: &[[usize; 2]]| bins.iter().all(|[all, cut]| 2 * cut > *all);
        self.counts.windows(CUT_BINS).position(mostly_cut).unwrap_or(self.counts.len())
    }
}

/// Fits a line to points by least squares and returns its slope. `None` for fewer than three points.
fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let count = points.len() as f64;
    let mean = points.iter().fold((0.0, 0.0), |sum, p| (sum.0 + p.0 / count, sum.1 + p.1 / count));
    let across = points.iter().map(|p| (p.0 - mean.0).powi(2)).sum::<f64>();
    let along = points.iter().map(|p| (p.0 - mean.0) * (p.1 - mean.1)).sum::<f64>();
    (points.len() > 2 && across > 0.0).then(|| along / across)
}

/// Returns the exponent b of sizes s, each with whether its cloud is cut: their number in equal steps of log s falls as
/// s^-b between the ends of `range`. Bins with fewer than 30 clouds do not count.
pub fn exponent(sizes: &[(f64, bool)], range: [f64; 2]) -> Option<f64> {
    // A cloud that fills the range lies in the last bin, not beyond it.
    let [first, last] = [range[0].log10(), (range[1] * (1.0 + 1e-6)).log10()];
    let bins = Bins::new(sizes, first, (last - first) / BINS as f64, BINS);
    let points: Vec<(f64, f64)> = (0..bins.end())
        .map(|bin| (bins.middle(bin), bins.counts[bin][0] as f64))
        .filter(|(_, count)| *count >= LEAST_COUNT)
        .map(|(middle, count)| (middle, count.log10()))
        .collect();
    slope(&points).map(|slope| -slope)
}

/// Returns the fractal dimension of single clouds: D of perimeter ~ area^(D/2) (Lovejoy 1982), as the slope of the
/// mean log perimeter over the log root of area in 30 bins. Holes are filled, and cut clouds left out.
pub fn fractal_dimension(masks: &[CloudMask]) -> Option<f64> {
    let logs = |mask: &CloudMask| {
        let clouds = clouds_of(&mask.whole_and_filled()).0;
        let of_cloud = |c: &super::Cloud| (0.5 * (c.pixels as f64).log10(), (c.perimeter as f64).log10());
        clouds.iter().map(of_cloud).filter(|(root, _)| *root > LEAST_ROOT.log10()).collect::<Vec<_>>()
    };
    let points: Vec<(f64, f64)> = masks.iter().flat_map(logs).collect();
    let low = points.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
    let high = points.iter().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
    let width = (high - low) / BINS as f64;
    if points.is_empty() || width <= 0.0 {
        return None;
    }
    let mut bins = [(0.0, 0.0); BINS];
    for (root, perimeter) in points {
        let bin = &mut bins[(((root - low) / width) as usize).min(BINS - 1)];
        *bin = (bin.0 + 1.0, bin.1 + perimeter);
    }
    let mean = |(i, (count, sum)): (usize, &(f64, f64))| (low + (i as f64 + 0.5) * width, sum / count);
    let means: Vec<(f64, f64)> = bins.iter().enumerate().filter(|(_, bin)| bin.0 > 0.0).map(mean).collect();
    slope(&means)
}

/// Ratio of one bin's diameters to those of the bin before, as a decimal logarithm.
const DIAMETER_BIN: f64 = 0.1;
/// Number of bins of diameters.
const DIAMETER_BINS: usize = 40;

/// Returns the number of clouds by diameter of the circle of equal area. `areas` are in pixels, each with whether the
/// cloud is cut; `ground_km2` is the area of all pictures. Empty bins are left out.
pub fn number_by_diameter(areas: &[(f64, bool)], pixel_m: f64, ground_km2: f64) -> Vec<SizeCount> {
    let diameter_m = |pixels: f64| (4.0 * pixels / std::f64::consts::PI).sqrt() * pixel_m;
    let diameters: Vec<(f64, bool)> = areas.iter().map(|(pixels, is_cut)| (diameter_m(*pixels), *is_cut)).collect();
    let bins = Bins::new(&diameters, diameter_m(LEAST_PIXELS).log10(), DIAMETER_BIN, DIAMETER_BINS);
    let size_count = |bin: usize| {
        let (count, middle) = (bins.counts[bin][0], bins.middle(bin));
        let width_m = 10f64.powf(middle + 0.5 * DIAMETER_BIN) - 10f64.powf(middle - 0.5 * DIAMETER_BIN);
        SizeCount { diameter_m: 10f64.powf(middle), count, per_km2_km: count as f64 / (ground_km2 * width_m / 1e3) }
    };
    (0..bins.end()).map(size_count).filter(|size| size.count > 0).collect()
}

/// Diameters among which the break is looked for, m.
const BREAKS_M: [f64; 2] = [250.0, 2500.0];
/// Number of diameters that are tried.
const BREAKS: usize = 47;
/// Deviation of a bin's logarithm beside that of its count: keeps bins with many clouds from deciding alone.
const DEVIATION: f64 = 0.05;

/// Fits two power laws that meet at a break: for each break by least squares, weighted by the deviation of the counts,
/// and of all breaks the one that leaves the smallest squares. `None` without three bins on each side.
pub fn broken_law(numbers: &[SizeCount]) -> Option<BrokenLaw> {
    let mut best: Option<(f64, BrokenLaw)> = None;
    for i in 0..BREAKS {
        let break_m = BREAKS_M[0] * (BREAKS_M[1] / BREAKS_M[0]).powf(i as f64 / (BREAKS - 1) as f64);
        let is_below = |size: &&SizeCount| size.diameter_m < break_m;
        let below = numbers.iter().filter(is_below).count();
        if below < 3 || numbers.len() - below < 3 {
            continue;
        }
        if let Some((squares, law)) = broken_at(numbers, break_m)
            && best.is_none_or(|(least, _)| squares < least)
        {
            best = Some((squares, law));
        }
    }
    best.map(|(_, law)| law)
}

/// Terms of the two laws at a size, the logarithm of its number density, and its weight in the fit.
type FitRow = ([f64; 3], f64, f64);

/// Fits the two laws for one break by the normal equations. Returns the weighted squares that are left.
fn broken_at(numbers: &[SizeCount], break_m: f64) -> Option<(f64, BrokenLaw)> {
    let rows: Vec<FitRow> = numbers
        .iter()
        .map(|size| {
            let x = (size.diameter_m / break_m).ln();
            let weight = 1.0 / (1.0 / size.count as f64 + DEVIATION * DEVIATION);
            ([1.0, x.min(0.0), x.max(0.0)], size.per_km2_km.ln(), weight)
        })
        .collect();
    let sum = |of: &dyn Fn(&FitRow) -> f64| rows.iter().map(of).sum::<f64>();
    let matrix = glam::DMat3::from_cols_array_2d(
        &[0, 1, 2].map(|i| [0, 1, 2].map(|j| sum(&|(terms, _, weight)| weight * terms[i] * terms[j]))),
    );
    let right = glam::DVec3::from_array([0, 1, 2].map(|i| sum(&|(terms, y, weight)| weight * terms[i] * y)));
    if matrix.determinant().abs() < 1e-12 {
        return None;
    }
    let fit = matrix.inverse() * right;
    let squares = sum(&|(terms, y, weight)| weight * (fit.dot(glam::DVec3::from_array(*terms)) - y).powi(2));
    Some((squares, BrokenLaw { below: fit.y, break_m, above: fit.z }))
}

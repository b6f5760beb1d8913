//! Rain drawn drop by drop in f64. As a reference it shares nothing with the code under test: no size classes, lattice,
//! shell, cone or table of Welkin's.
//!
//! Each drop in front of the camera has its own position, and its own diameter from Marshall and Palmer's distribution
//! (1948; N0 is set so that the flux equals the rain rate). It falls at the speed measured by Gunn and Kinzer (1949).
//! While the shutter is open, the drop's disc moves along its path. It hides a pixel for the part of the exposure in
//! which it covers the pixel. This is the photometric model of Garg and Nayar (2007): (tau / T) (E_drop -
//! E_background), where tau = 2 a / v for a drop of radius a whose centre passes over the pixel. Disc and path are
//! divided into points, and each point counts for the pixel that it falls on; the sums are exact in the limit of many
//! points.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

/// Terminal speeds of drops: diameter, mm, and speed, cm/s (Gunn and Kinzer 1949, table 2).
const SPEEDS: [(f64, f64); 36] = [
    (0.0, 0.0),
    (0.078, 18.0),
    (0.1, 27.0),
    (0.2, 72.0),
    (0.3, 117.0),
    (0.4, 162.0),
    (0.5, 206.0),
    (0.6, 247.0),
    (0.7, 287.0),
    (0.8, 327.0),
    (0.9, 367.0),
    (1.0, 403.0),
    (1.2, 464.0),
    (1.4, 517.0),
    (1.6, 565.0),
    (1.8, 609.0),
    (2.0, 649.0),
    (2.2, 690.0),
    (2.4, 727.0),
    (2.6, 757.0),
    (2.8, 782.0),
    (3.0, 806.0),
    (3.2, 826.0),
    (3.4, 844.0),
    (3.6, 860.0),
    (3.8, 872.0),
    (4.0, 883.0),
    (4.2, 892.0),
    (4.4, 898.0),
    (4.6, 903.0),
    (4.8, 907.0),
    (5.0, 909.0),
    (5.2, 912.0),
    (5.4, 914.0),
    (5.6, 916.0),
    (5.8, 917.0),
];

/// Terminal speed, m/s, interpolated linearly between the measurements.
pub fn speed_m_s(diameter_mm: f64) -> f64 {
    let i = SPEEDS.partition_point(|s| s.0 <= diameter_mm).clamp(1, SPEEDS.len() - 1);
    let ((a, va), (b, vb)) = (SPEEDS[i - 1], SPEEDS[i]);
    0.01 * (va + (vb - va) * ((diameter_mm - a) / (b - a)).min(1.0))
}

/// Random number generator: SplitMix64.
pub struct RandomStream(pub u64);

impl RandomStream {
    /// Uniform random number in [0, 1).
    pub fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Random whole number with this mean: one of the two next to it.
    fn count(&mut self, mean: f64) -> u64 {
        (mean + self.even()) as u64
    }
}

/// Drops of steady rain per cubic metre: N(D) = n0 exp(-slope D), D in mm.
#[derive(Clone, Copy)]
pub struct Spectrum {
    pub n0: f64,
    pub slope: f64,
}

/// Range of drop diameters, mm.
const DIAMETERS_MM: (f64, f64) = (0.1, 6.0);

impl Spectrum {
    /// Spectrum for a rain rate, mm/h (Marshall and Palmer 1948).
    pub fn of(rate_mm_h: f64) -> Self {
        let slope = 4.1 * rate_mm_h.powf(-0.21);
        let n = 4000;
        let step = (DIAMETERS_MM.1 - DIAMETERS_MM.0) / f64::from(n);
        // 1 mm^3 per square metre and second is 1e-6 mm/s.
        let falls: f64 = (0..n)
            .map(|i| DIAMETERS_MM.0 + step * (f64::from(i) + 0.5))
            .map(|d| (-slope * d).exp() * PI / 6.0 * d.powi(3) * speed_m_s(d) * step * 3.6e-3)
            .sum();
        Self { n0: rate_mm_h / falls, slope }
    }

    /// Number of drops larger than a diameter, 1/m^3.
    fn number(&self, from_mm: f64) -> f64 {
        let upto = |d: f64| (-self.slope * d).exp();
        self.n0 / self.slope * (upto(from_mm) - upto(DIAMETERS_MM.1))
    }

    /// Diameter above which a share `1 - u` of all drops larger than `from_mm` lies.
    fn diameter_mm(&self, from_mm: f64, u: f64) -> f64 {
        let upto = |d: f64| (-self.slope * d).exp();
        -(upto(from_mm) + u * (upto(DIAMETERS_MM.1) - upto(from_mm))).ln() / self.slope
    }
}

/// A camera that looks north (along y), upright, and the rain in front of it.
#[derive(Clone, Copy)]
pub struct Film {
    pub size: (u32, u32),
    pub fov_rad: f64,
    pub exposure_s: f64,
    pub rate_mm_h: f64,
    /// Velocity of the air, (east, north, up), m/s.
    pub wind_m_s: DVec3,
    /// Velocity of the camera, (east, north, up), m/s.
    pub camera_m_s: DVec3,
    /// The smallest drops that are drawn, mm.
    pub from_mm: f64,
    /// Drops fade in between the distances `near_m` and end at `far_m`, m.
    pub near_m: (f64, f64),
    pub far_m: f64,
}

/// A drop: its position relative to the camera at time 0, the middle of the first picture's exposure, m, and its
/// velocity relative to the camera, m/s.
#[derive(Clone, Copy)]
pub struct Drop {
    pub position_m: DVec3,
    pub velocity_m_s: DVec3,
    pub diameter_m: f64,
}

/// Depth of the slices in which drops are placed, m.
const SLICE_M: f64 = 0.25;

impl Film {
    /// Focal length in pixels: the size in pixels of 1 m at a distance of 1 m.
    fn focal(&self) -> f64 {
        0.5 * f64::from(self.size.1) / (0.5 * self.fov_rad).tan()
    }

    /// All drops that can appear in pictures taken within this many seconds.
    pub fn drops(&self, seed: u64, lasts_s: f64) -> Vec<Drop> {
        let mut chance = RandomStream(seed);
        let spectrum = Spectrum::of(self.rate_mm_h);
        let number = spectrum.number(self.from_mm);
        let fastest = (self.wind_m_s - self.camera_m_s).length() + speed_m_s(DIAMETERS_MM.1);
        let margin = fastest * (lasts_s + self.exposure_s);
        let half = DVec2::new(f64::from(self.size.0), f64::from(self.size.1)) * 0.5 / self.focal();
        let mut all = Vec::new();
        let slices = ((self.far_m + margin) / SLICE_M).ceil() as u32;
        for i in 0..slices {
            let y = SLICE_M * f64::from(i);
            let side = half * (y + SLICE_M) + margin;
            for _ in 0..chance.count(number * 4.0 * side.x * side.y * SLICE_M) {
                let [u, v, w, d] = [0; 4].map(|_| chance.even());
                let mm = spectrum.diameter_mm(self.from_mm, d);
                all.push(Drop {
                    position_m: DVec3::new(side.x * (2.0 * u - 1.0), y + SLICE_M * v, side.y * (2.0 * w - 1.0)),
                    velocity_m_s: self.wind_m_s - self.camera_m_s - DVec3::Z * speed_m_s(mm),
                    diameter_m: 1e-3 * mm,
                });
            }
        }
        all
    }

    /// Share of each pixel's exposure that drops hide, with the shutter open around `time_s`. Drops in front of each
    /// other combine.
    pub fn cover(&self, drops: &[Drop], time_s: f64) -> Vec<f64> {
        let mut sums = vec![0.0f64; (self.size.0 * self.size.1) as usize];
        for drop in drops {
            self.deposit(&mut sums, drop, drop.position_m + drop.velocity_m_s * time_s);
        }
        sums.iter().map(|s| 1.0 - (-s).exp()).collect()
    }

    fn pixel(&self, p: DVec3) -> DVec2 {
        let middle = DVec2::new(f64::from(self.size.0), f64::from(self.size.1)) * 0.5;
        middle + DVec2::new(p.x, -p.z) * (self.focal() / p.y)
    }

    /// Share of a drop that is drawn, by distance.
    fn share(&self, distance_m: f64) -> f64 {
        let t = ((distance_m - self.near_m.0) / (self.near_m.1 - self.near_m.0)).clamp(0.0, 1.0);
        if distance_m < self.far_m { t * t * (3.0 - 2.0 * t) } else { 0.0 }
    }

    fn deposit(&self, sums: &mut [f64], drop: &Drop, p: DVec3) {
        let share = self.share(p.length());
        let half = drop.velocity_m_s * (0.5 * self.exposure_s);
        if share <= 0.0 || p.y <= 0.05 || half.y.abs() > 0.6 * p.y {
            return;
        }
        let size = DVec2::new(f64::from(self.size.0), f64::from(self.size.1));
        let (a, b) = (self.pixel(p - half), self.pixel(p + half));
        let radius = 0.5 * drop.diameter_m * self.focal() / p.y;
        let (low, high) = (a.min(b) - radius - 1.0, a.max(b) + radius + 1.0);
        if high.min_element() < 0.0 || low.cmpgt(size).any() {
            return;
        }
        let along = (4.0 * (b - a).length()).ceil().clamp(4.0, 4000.0) as u32;
        let points = (16.0 * radius * radius).ceil().clamp(4.0, 600.0) as u32;
        // Away from the picture's centre, a sphere's image is stretched.
        let weight = share * PI * radius * radius * (p.length() / p.y) / f64::from(along * points);
        for j in 0..points {
            // Spread evenly over the disc, by the golden angle (Vogel 1979).
            let r = radius * ((f64::from(j) + 0.5) / f64::from(points)).sqrt();
            let turn = 2.399_963_229_728_653 * f64::from(j);
            let off = r * DVec2::from_angle(turn);
            // Each point of the disc starts at a different part of a step.
            let begin = (0.618_033_988_75 * f64::from(j)).fract();
            for i in 0..along {
                let at = a + (b - a) * ((f64::from(i) + begin) / f64::from(along)) + off;
                if at.x >= 0.0 && at.y >= 0.0 && at.x < size.x && at.y < size.y {
                    sums[at.y as usize * self.size.0 as usize + at.x as usize] += weight;
                }
            }
        }
    }
}

/// Mean radiance of a sphere of water seen along the unit vector `view`, in surroundings that send `radiance` from each
/// direction. Traces rays through the sphere with Snell's refraction and Fresnel's shares: the ray that passes through,
/// the one reflected outside, and the one reflected once inside.
pub fn sphere_radiance(view: DVec3, radiance: impl Fn(DVec3) -> f64) -> f64 {
    const WATER: f64 = 1.333;
    let side = view.any_orthonormal_vector();
    let up = view.cross(side);
    let (rings, turns) = (200, 64);
    let mut sum = 0.0;
    for i in 0..rings {
        // Rings of equal area of the disc.
        let sine = ((f64::from(i) + 0.5) / f64::from(rings)).sqrt();
        let (outside, inside) = (sine.asin(), (sine / WATER).asin());
        let (co, ci) = (outside.cos(), inside.cos());
        let (s, p) = ((co - WATER * ci) / (co + WATER * ci), (ci - WATER * co) / (ci + WATER * co));
        let reflected = 0.5 * (s * s + p * p);
        // Angle by which each ray is turned from `view`; positive is towards the centre.
        let ways = [
            (2.0 * outside - PI, reflected),
            (2.0 * (outside - inside), (1.0 - reflected).powi(2)),
            (PI + 2.0 * outside - 4.0 * inside, (1.0 - reflected).powi(2) * reflected),
        ];
        for k in 0..turns {
            let (sin, cos) = (2.0 * PI * (f64::from(k) + 0.5) / f64::from(turns)).sin_cos();
            let outward = side * cos + up * sin;
            for (turn, part) in ways {
                let to = view * turn.cos() - outward * turn.sin();
                sum += part * radiance(to) / f64::from(rings * turns);
            }
        }
    }
    sum
}

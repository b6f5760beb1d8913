//! Radiance inside a scattering slab by adding and doubling (van de Hulst; Hansen and Travis 1974), many streams, all
//! azimuths: the truth for the light in fog.

/// Streams a hemisphere.
pub const N: usize = 24;

type Matrix = Vec<[f64; N]>;
type Vector = [f64; N];

/// Gauss-Legendre nodes and weights on (0, 1).
pub fn gauss() -> (Vector, Vector) {
    let (mut x, mut w) = ([0.0; N], [0.0; N]);
    for i in 0..N {
        let mut z = (std::f64::consts::PI * (i as f64 + 0.75) / (N as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..50 {
            let (mut p0, mut p1) = (1.0, z);
            for l in 2..=N {
                (p0, p1) = (p1, ((2 * l - 1) as f64 * z * p1 - (l - 1) as f64 * p0) / l as f64);
            }
            slope = N as f64 * (z * p1 - p0) / (z * z - 1.0);
            z -= p1 / slope;
        }
        x[i] = 0.5 * (1.0 - z);
        w[i] = 1.0 / ((1.0 - z * z) * slope * slope);
    }
    (x, w)
}

/// Associated Legendre functions times sqrt((l-m)!/(l+m)!), for l < count.
fn legendre(m: usize, count: usize, x: f64) -> Vec<f64> {
    let mut y = vec![0.0; count];
    if m >= count {
        return y;
    }
    let s = (1.0 - x * x).max(0.0).sqrt();
    let mut v = 1.0;
    for i in 1..=m {
        v *= s * ((2 * i - 1) as f64 / (2 * i) as f64).sqrt();
    }
    y[m] = v;
    for l in m + 1..count {
        let (lf, mf) = (l as f64, m as f64);
        let below = if l >= 2 { y[l - 2] } else { 0.0 };
        let a = ((lf - 1.0).powi(2) - mf * mf).max(0.0).sqrt();
        y[l] = ((2.0 * lf - 1.0) * x * y[l - 1] - a * below) / (lf * lf - mf * mf).sqrt();
    }
    y
}

fn multiply(a: &Matrix, b: &Matrix) -> Matrix {
    let mut out = vec![[0.0; N]; N];
    for i in 0..N {
        for k in 0..N {
            let f = a[i][k];
            for j in 0..N {
                out[i][j] += f * b[k][j];
            }
        }
    }
    out
}

fn apply(a: &Matrix, v: &Vector) -> Vector {
    std::array::from_fn(|i| a[i].iter().zip(v).map(|(x, y)| x * y).sum())
}

fn add(a: &Vector, b: &Vector, scale: f64) -> Vector {
    std::array::from_fn(|i| a[i] + scale * b[i])
}

/// (1 - a)^-1 by Gauss-Jordan elimination with pivots.
fn resolvent(a: &Matrix) -> Matrix {
    let mut left: Matrix = a.clone();
    let mut right = vec![[0.0; N]; N];
    for i in 0..N {
        for j in 0..N {
            left[i][j] = f64::from(u8::from(i == j)) - a[i][j];
        }
        right[i][i] = 1.0;
    }
    for c in 0..N {
        let pivot = (c..N).max_by(|i, j| left[*i][c].abs().total_cmp(&left[*j][c].abs())).unwrap();
        left.swap(c, pivot);
        right.swap(c, pivot);
        let f = 1.0 / left[c][c];
        for j in 0..N {
            left[c][j] *= f;
            right[c][j] *= f;
        }
        for r in (0..N).filter(|r| *r != c) {
            let f = left[r][c];
            let (row, inverse) = (left[c], right[c]);
            for j in 0..N {
                left[r][j] -= f * row[j];
                right[r][j] -= f * inverse[j];
            }
        }
    }
    right
}

/// Response of a layer to light from outside and to the beam, for one azimuth order.
#[derive(Clone)]
struct Layer {
    r: Matrix,
    t: Matrix,
    up: Vector,
    down: Vector,
    /// Transmittance of the beam.
    beam: f64,
}

/// Inputs of a solution.
pub struct Case<'a> {
    /// Legendre moments of the phase function, the first of them 1.
    pub moments: &'a [f64],
    pub albedo: f64,
    /// Depths above and below the observer.
    pub above: f64,
    pub below: f64,
    pub mu0: f64,
    /// Irradiance of the sun on a surface facing it, of the sky on a horizontal surface, and reflectance of the ground.
    pub sun: f64,
    pub sky: f64,
    pub ground: f64,
}

/// Radiance at the observer, `[azimuth][stream]`: travelling down (seen looking up) and up.
pub struct Answer {
    pub down: Vec<Vector>,
    pub up: Vec<Vector>,
}

impl Case<'_> {
    fn layer(&self, m: usize, depth: f64) -> Layer {
        let (x, w) = gauss();
        let count = self.moments.len();
        let y: Vec<_> = x.iter().map(|x| legendre(m, count, *x)).collect();
        let y0 = legendre(m, count, self.mu0);
        let phase = |a: &[f64], b: &[f64], sign: f64| -> f64 {
            (m..count)
                .map(|l| {
                    let parity = if (l + m).is_multiple_of(2) { 1.0 } else { sign };
                    (2 * l + 1) as f64 * self.moments[l] * a[l] * b[l] * parity
                })
                .sum()
        };
        let doublings = 26;
        let d = depth / f64::from(1u32 << doublings);
        let twice = if m == 0 { 1.0 } else { 2.0 };
        let mut layer = Layer {
            r: vec![[0.0; N]; N],
            t: vec![[0.0; N]; N],
            up: [0.0; N],
            down: [0.0; N],
            beam: (-d / self.mu0).exp(),
        };
        for i in 0..N {
            let f = d / x[i] * self.albedo;
            for j in 0..N {
                layer.r[i][j] = 0.5 * f * w[j] * phase(&y[i], &y[j], -1.0);
                layer.t[i][j] = 0.5 * f * w[j] * phase(&y[i], &y[j], 1.0);
            }
            layer.t[i][i] += 1.0 - d / x[i];
            let source = f * self.sun * twice / (4.0 * std::f64::consts::PI);
            layer.up[i] = source * phase(&y[i], &y0, -1.0);
            layer.down[i] = source * phase(&y[i], &y0, 1.0);
        }
        for _ in 0..doublings {
            layer = double(&layer);
        }
        layer
    }

    /// Solves for `azimuths` (radians from the sun's).
    pub fn solve(&self, azimuths: &[f64]) -> Answer {
        let zero = vec![[0.0; N]; azimuths.len()];
        let mut answer = Answer { down: zero.clone(), up: zero };
        for m in 0..self.moments.len().min(2 * N) {
            let [down, up, _] = self.order(m);
            for (k, phi) in azimuths.iter().enumerate() {
                let c = (m as f64 * phi).cos();
                answer.down[k] = add(&answer.down[k], &down, c);
                answer.up[k] = add(&answer.up[k], &up, c);
            }
        }
        answer
    }

    /// Down and up at the observer, and out of the top, for azimuth order `m`.
    fn order(&self, m: usize) -> [Vector; 3] {
        let top = self.layer(m, self.above);
        let mut bottom = self.layer(m, self.below);
        let pi = std::f64::consts::PI;
        let mut sky = [0.0; N];
        if m == 0 {
            let (x, w) = gauss();
            let reflect: Matrix = vec![std::array::from_fn(|j| 2.0 * self.ground * w[j] * x[j]); N];
            let lit = self.ground * self.mu0 * self.sun * bottom.beam / pi;
            let g = resolvent(&multiply(&reflect, &bottom.r));
            let tg = multiply(&bottom.t, &g);
            let source = add(&[lit; N], &apply(&reflect, &bottom.down), 1.0);
            bottom.up = add(&bottom.up, &apply(&tg, &source), 1.0);
            let extra = multiply(&multiply(&tg, &reflect), &bottom.t);
            for (row, more) in bottom.r.iter_mut().zip(&extra) {
                *row = add(row, more, 1.0);
            }
            sky = [self.sky / pi; N];
        }
        let from_below: Vector = bottom.up.map(|v| v * top.beam);
        let g = resolvent(&multiply(&top.r, &bottom.r));
        let into = add(&add(&top.down, &apply(&top.t, &sky), 1.0), &apply(&top.r, &from_below), 1.0);
        let down = apply(&g, &into);
        let up = add(&apply(&bottom.r, &down), &from_below, 1.0);
        let out = add(&add(&top.up, &apply(&top.r, &sky), 1.0), &apply(&top.t, &up), 1.0);
        [down, up, out]
    }
}

fn double(l: &Layer) -> Layer {
    let g = resolvent(&multiply(&l.r, &l.r));
    let tg = multiply(&l.t, &g);
    let from_below = l.up.map(|v| v * l.beam);
    let rise = add(&from_below, &apply(&l.r, &l.down), 1.0);
    let fall = add(&l.down, &apply(&l.r, &from_below), 1.0);
    let tgr = multiply(&multiply(&tg, &l.r), &l.t);
    Layer {
        r: (0..N).map(|i| add(&l.r[i], &tgr[i], 1.0)).collect(),
        t: multiply(&tg, &l.t),
        up: add(&l.up, &apply(&tg, &rise), 1.0),
        down: add(&l.down.map(|v| v * l.beam), &apply(&tg, &fall), 1.0),
        beam: l.beam * l.beam,
    }
}

/// Moments g^l of Henyey and Greenstein.
pub fn henyey_greenstein(g: f64) -> Vec<f64> {
    (0..2 * N).map(|l| g.powi(l as i32)).collect()
}

/// Truth: slabs of Henyey-Greenstein g = 0.85 by discrete ordinates, (depth, mu0, albedo, R).
#[test]
fn the_reference_meets_the_published_slabs() {
    let (x, w) = gauss();
    let moments = henyey_greenstein(0.85);
    for (depth, mu0, albedo, r) in [
        (1.0, 1.0, 1.0, 0.04232),
        (4.0, 0.5, 1.0, 0.41602),
        (16.0, 1.0, 1.0, 0.55721),
        (64.0, 0.5, 1.0, 0.89497),
        (4.0, 1.0, 0.99, 0.17284),
    ] {
        let case = Case {
            moments: &moments,
            albedo,
            above: depth / 2.0,
            below: depth / 2.0,
            mu0,
            sun: 1.0 / mu0,
            sky: 0.0,
            ground: 0.0,
        };
        let [_, _, top] = case.order(0);
        let up: f64 = (0..N).map(|i| 2.0 * std::f64::consts::PI * w[i] * x[i] * top[i]).sum();
        assert!((up - r).abs() < 3e-5, "depth {depth} mu0 {mu0}: {up} of {r}");
    }
}

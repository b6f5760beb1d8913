//! Mie's theory (Mie 1908) by the recurrences of Bohren and Huffman (1983), section 4.8: scattering by a sphere of
//! water, without rays.

#[derive(Clone, Copy)]
struct Complex(f64, f64);

impl Complex {
    fn times(self, o: Self) -> Self {
        Self(self.0 * o.0 - self.1 * o.1, self.0 * o.1 + self.1 * o.0)
    }

    fn over(self, o: Self) -> Self {
        let n = o.0 * o.0 + o.1 * o.1;
        Self((self.0 * o.0 + self.1 * o.1) / n, (self.1 * o.0 - self.0 * o.1) / n)
    }
}

/// Coefficients a_n and b_n of a sphere of size `x` (circumference over wavelength) that absorbs no light.
fn coefficients(x: f64, index: f64) -> Vec<[Complex; 2]> {
    let terms = (x + 4.0 * x.cbrt() + 2.0) as usize;
    let inner = index * x;
    let first = terms.max(inner as usize) + 16;
    // Logarithmic derivative of psi inside, downwards.
    let mut d = vec![0.0; first + 1];
    for n in (1..=first).rev() {
        let k = n as f64 / inner;
        d[n - 1] = k - 1.0 / (d[n] + k);
    }
    // psi and chi upwards: psi_-1 = cos, psi_0 = sin.
    let (mut psi0, mut psi1) = (x.cos(), x.sin());
    let (mut chi0, mut chi1) = (-x.sin(), x.cos());
    (1..=terms)
        .map(|n| {
            let nf = n as f64;
            let psi = (2.0 * nf - 1.0) * psi1 / x - psi0;
            let chi = (2.0 * nf - 1.0) * chi1 / x - chi0;
            let of = |t: f64| {
                let (over, before) = (Complex(t * psi - psi1, 0.0), Complex(t * psi - psi1, -(t * chi - chi1)));
                over.over(before)
            };
            let answer = [of(d[n] / index + nf / x), of(d[n] * index + nf / x)];
            (psi0, psi1, chi0, chi1) = (psi1, psi, chi1, chi);
            answer
        })
        .collect()
}

/// Returns the unpolarised light that a sphere scatters to angles with the given cosines, 1/sr, as a share of the light
/// that falls on a square whose side is the sphere's radius.
pub fn intensities(x: f64, index: f64, cosines: &[f64]) -> Vec<f64> {
    let terms = coefficients(x, index);
    let one = |mu: f64| {
        let (mut pi0, mut pi1) = (0.0, 1.0);
        let (mut s1, mut s2) = (Complex(0.0, 0.0), Complex(0.0, 0.0));
        for (i, [a, b]) in terms.iter().enumerate() {
            let n = (i + 1) as f64;
            let tau = n * mu * pi1 - (n + 1.0) * pi0;
            let f = (2.0 * n + 1.0) / (n * (n + 1.0));
            let add =
                |s: Complex, p: f64, q: f64| Complex(s.0 + f * (a.0 * p + b.0 * q), s.1 + f * (a.1 * p + b.1 * q));
            (s1, s2) = (add(s1, pi1, tau), add(s2, tau, pi1));
            let next = ((2.0 * n + 1.0) * mu * pi1 - (n + 1.0) * pi0) / n;
            (pi0, pi1) = (pi1, next);
        }
        let square = |s: Complex| s.times(Complex(s.0, -s.1)).0;
        (square(s1) + square(s2)) / (2.0 * x * x)
    };
    cosines.iter().map(|mu| one(*mu)).collect()
}

#[test]
fn small_spheres_scatter_as_rayleigh_and_large_ones_take_twice_their_face() {
    let [ahead, aside, back] = intensities(0.01, 1.33, &[1.0, 0.0, -1.0])[..] else { panic!("three") };
    assert!((aside / ahead - 0.5).abs() < 1e-3 && (back / ahead - 1.0).abs() < 1e-3, "{ahead} {aside} {back}");
    // The scattered light divided by the drop's cross-section: the extinction efficiency is 2, and without absorption
    // all of it is scattering.
    let x = 400.0;
    let n = 40_000;
    let cosines: Vec<f64> =
        (0..n).map(|i| ((f64::from(i) + 0.5) / f64::from(n) * std::f64::consts::PI).cos()).collect();
    let step = std::f64::consts::PI / f64::from(n);
    let all: f64 =
        intensities(x, 1.333, &cosines).iter().zip(&cosines).map(|(i, c)| i * (1.0 - c * c).sqrt() * step * 2.0).sum();
    println!("extinction of a drop of size {x}: {all:.3}");
    assert!((all - 2.0).abs() < 0.06, "{all}");
}

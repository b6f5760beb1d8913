//! Integration and interpolation rules of the sky's reference solution.

use std::sync::LazyLock;

/// Gauss-Legendre rule on [-1, 1] with the matrix that integrates from -1 up to each node.
pub struct Gauss {
    /// Nodes, ascending.
    pub nodes: Vec<f64>,
    /// Weights; they sum to 2.
    pub weights: Vec<f64>,
    /// Weights of the partial integrals: `running[i * n + j]` is the weight of the value at node j in the integral
    /// from -1 to node i. Exact for polynomials of degree below n.
    pub running: Vec<f64>,
}

/// Rule with 16 nodes, for smooth panels of optical paths.
pub static GAUSS_16: LazyLock<Gauss> = LazyLock::new(|| Gauss::new(16));

impl Gauss {
    /// Creates the rule with `n` nodes (at least 1), exact for polynomials of degree 2 n - 1. The nodes are found by
    /// Newton's method on the Legendre polynomial, starting from Tricomi's estimate.
    pub fn new(n: usize) -> Self {
        let n = n.max(1);
        let mut nodes = vec![0.0; n];
        let mut weights = vec![0.0; n];
        for i in 0..n {
            let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            for _ in 0..100 {
                let p = legendre(n, x);
                let slope = n as f64 * (x * p[n] - p[n - 1]) / (x * x - 1.0);
                let step = p[n] / slope;
                x -= step;
                if step.abs() < 1e-15 {
                    break;
                }
            }
            let p = legendre(n, x);
            let slope = n as f64 * (x * p[n] - p[n - 1]) / (x * x - 1.0);
            nodes[i] = x;
            weights[i] = 2.0 / ((1.0 - x * x) * slope * slope);
        }
        let running = running_weights(&nodes, &weights);
        Self { nodes, weights, running }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether the rule has no node, which never happens.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Integral of `f` over `[a, b]`.
    pub fn integrate(&self, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        self.nodes.iter().zip(&self.weights).map(|(x, w)| w * f(middle + half * x)).sum::<f64>() * half
    }
}

/// Legendre polynomials P_0 .. P_n at x.
fn legendre(n: usize, x: f64) -> Vec<f64> {
    let mut p = vec![1.0, x];
    for k in 1..n {
        let k_f = k as f64;
        p.push(((2.0 * k_f + 1.0) * x * p[k] - k_f * p[k - 1]) / (k_f + 1.0));
    }
    p
}

/// Weights of the partial integrals: cardinal polynomials of the nodes, expanded in Legendre polynomials and integrated
/// term by term.
fn running_weights(nodes: &[f64], weights: &[f64]) -> Vec<f64> {
    let n = nodes.len();
    let at: Vec<Vec<f64>> = nodes.iter().map(|x| legendre(n + 1, *x)).collect();
    let mut running = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            let mut sum = 0.5 * (nodes[i] + 1.0);
            for k in 1..n {
                sum += 0.5 * at[j][k] * (at[i][k + 1] - at[i][k - 1]);
            }
            running[i * n + j] = weights[j] * sum;
        }
    }
    running
}

/// Index of the first of four neighbours, and their weights, for cubic (Lagrange) interpolation at `x` in units of the
/// node spacing, among `n` nodes (at least 4) at 0, 1, .. n - 1. Beyond the ends the value is that of the end.
pub fn cubic(x: f64, n: usize) -> (usize, [f64; 4]) {
    let x = x.clamp(0.0, (n - 1) as f64);
    let first = (x as usize).saturating_sub(1).min(n - 4);
    (first, cubic_weights(x - first as f64))
}

/// Lagrange weights of nodes 0, 1, 2, 3 at `x`.
pub fn cubic_weights(x: f64) -> [f64; 4] {
    let (a, b, c) = (x - 1.0, x - 2.0, x - 3.0);
    [-a * b * c / 6.0, x * b * c / 2.0, -x * a * c / 2.0, x * a * b / 6.0]
}

/// Index of the lower neighbour and the share of the upper one, for linear interpolation at `x` among `n` nodes (at
/// least 2), otherwise as [`cubic`].
pub fn linear(x: f64, n: usize) -> (usize, f64) {
    let x = x.clamp(0.0, (n - 1) as f64);
    let i = (x as usize).min(n - 2);
    (i, x - i as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauss_is_exact_for_its_degree_and_no_further() {
        for n in [1, 2, 5, 8, 16, 48] {
            let g = Gauss::new(n);
            let moment = |k: i32| g.integrate(-1.0, 1.0, |x| x.powi(k));
            for k in 0..2 * n as i32 {
                let exact = if k % 2 == 0 { 2.0 / f64::from(k + 1) } else { 0.0 };
                assert!((moment(k) - exact).abs() < 1e-13, "n {n} degree {k}: {}", moment(k));
            }
            if n < 16 {
                assert!((moment(2 * n as i32) - 2.0 / f64::from(2 * n as i32 + 1)).abs() > 1e-7);
            }
        }
    }

    #[test]
    fn running_integral_follows_the_exact_one() {
        let g = Gauss::new(8);
        for i in 0..8 {
            let sum: f64 = (0..8).map(|j| g.running[i * 8 + j] * g.nodes[j].exp()).sum();
            assert!((sum - (g.nodes[i].exp() - (-1f64).exp())).abs() < 1e-7, "node {i}: {sum}");
        }
    }

    #[test]
    fn cubic_reproduces_cubics_and_holds_at_the_ends() {
        let f = |x: f64| 2.0 - x + 0.5 * x * x - 0.1 * x * x * x;
        for x in [0.0, 0.3, 1.0, 4.7, 8.99, 9.0] {
            let (i, w) = cubic(x, 10);
            let sum: f64 = (0..4).map(|k| w[k] * f((i + k) as f64)).sum();
            assert!((sum - f(x)).abs() < 1e-10, "{x}");
        }
        assert_eq!(cubic(12.0, 10), cubic(9.0, 10));
    }
}

//! Finds the candidates worth choosing, and how a cost grows.

/// Indices of the points (cost, error) on the Pareto front, in order of cost. A point is on the front if no other point
/// is at most equal in both values and smaller in one. Equal points are all kept. Points that are not finite are left
/// out.
pub fn pareto(points: &[[f64; 2]]) -> Vec<usize> {
    let finite = |i: &usize| points[*i].iter().all(|v| v.is_finite());
    let beats = |a: &[f64; 2], b: &[f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    let mut front: Vec<usize> = (0..points.len())
        .filter(finite)
        .filter(|i| !(0..points.len()).filter(finite).any(|j| beats(&points[j], &points[*i])))
        .collect();
    front.sort_by(|a, b| points[*a][0].total_cmp(&points[*b][0]));
    front
}

/// Exponent p of the best fit of y ~ x^p (least squares of logarithms), and the largest factor between a point and the
/// fit. `None` for fewer than two different x, or for numbers that are not above 0.
pub fn growth(points: &[[f64; 2]]) -> Option<(f64, f64)> {
    if points.len() < 2 || points.iter().flatten().any(|v| !(*v > 0.0 && v.is_finite())) {
        return None;
    }
    let logs: Vec<[f64; 2]> = points.iter().map(|p| p.map(f64::ln)).collect();
    let n = logs.len() as f64;
    let mean = [0, 1].map(|k| logs.iter().map(|p| p[k]).sum::<f64>() / n);
    let spread: f64 = logs.iter().map(|p| (p[0] - mean[0]).powi(2)).sum();
    if spread < 1e-12 {
        return None;
    }
    let slope = logs.iter().map(|p| (p[0] - mean[0]) * (p[1] - mean[1])).sum::<f64>() / spread;
    let miss = logs.iter().map(|p| (p[1] - mean[1] - slope * (p[0] - mean[0])).abs()).fold(0.0, f64::max);
    Some((slope, miss.exp()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_the_points_that_no_other_point_beats() {
        let points = [[1.0, 5.0], [2.0, 2.0], [3.0, 3.0], [4.0, 1.0], [1.0, 6.0], [2.0, 2.0], [0.1, f64::NAN]];
        assert_eq!(pareto(&points), [0, 1, 5, 3]);
        assert!(pareto(&[]).is_empty());
        assert_eq!(pareto(&[[f64::INFINITY, 0.0], [1.0, 1.0]]), [1]);
    }

    #[test]
    fn growth_finds_the_exponent_and_says_how_well_it_fits() {
        let square: Vec<[f64; 2]> = (1..6).map(|i| [f64::from(i), 3.0 * f64::from(i * i)]).collect();
        let (p, miss) = growth(&square).unwrap();
        assert!((p - 2.0).abs() < 1e-12 && (miss - 1.0).abs() < 1e-9);
        let (p, miss) = growth(&[[1.0, 1.0], [2.0, 4.0], [4.0, 4.0]]).unwrap();
        assert!((p - 1.0).abs() < 1e-12 && miss > 1.3, "{p} {miss}");
        assert!(growth(&[[1.0, 1.0]]).is_none() && growth(&[[1.0, 1.0], [1.0, 2.0]]).is_none());
        assert!(growth(&[[1.0, 0.0], [2.0, 2.0]]).is_none());
    }
}

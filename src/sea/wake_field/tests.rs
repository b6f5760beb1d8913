//! Wakes against Kelvin's integral, the laws of their decay and angles, and their continuity.

use super::*;
use crate::sea::track::tests::track;

/// A slender hull, whose waves are too low to be limited, heading east; its middle is at the origin at 1000 s.
fn slender(speed_m_s: f64, turn_deg_s: f64) -> SeaHull {
    SeaHull {
        beam_m: 0.4,
        draught_m: 0.3,
        length_m: 30.0,
        heading_deg: 90.0,
        speed_m_s,
        turn_deg_s,
        ..SeaHull::default()
    }
}

fn wake(hull: SeaHull, time_s: f64) -> Wake {
    let mut wake = Wake::default();
    wake.fill(&track(hull), time_s);
    wake
}

fn height(wake: &Wake, place_m: DVec2) -> f64 {
    let mut sum = WakePoint::default();
    wake.add_at(place_m, 0.0, &mut sum);
    sum.height_m
}

/// Kelvin's integral over all directions of waves of a hull at the origin that heads east (Michell 1898).
fn integral(hull: &SeaHull, place_m: DVec2) -> f64 {
    let of = Wake { hull: *hull, ..Wake::default() };
    let (steps, most) = (40_000, 4.0);
    let h = 2.0 * most / f64::from(steps);
    let mut sum = 0.0;
    for i in 0..=steps {
        // Directions by the tangent's area sine, dense where waves are long.
        let x = h * f64::from(i) - most;
        let (tangent, weight) = (libm::sinh(x), libm::cosh(x));
        let cosine = 1.0 / libm::sqrt(1.0 + tangent * tangent);
        let mut re = 0.0;
        for end in [HullEnd::Bow, HullEnd::Stern] {
            let (k, raw) = of.raised(hull.speed_m_s, cosine, end);
            let ahead = place_m.x - 0.5 * end.sign() * hull.length_m;
            let (sin, cos) = libm::sincos(k * cosine * (ahead + place_m.y * tangent));
            re += raw.x * cos - raw.y * sin;
        }
        sum += re * weight * cosine * cosine * h;
    }
    sum
}

#[test]
fn straight_wakes_are_kelvin_s() {
    for speed in [4.0, 6.0, 9.0] {
        let hull = slender(speed, 0.0);
        let straight = wake(hull, 1000.0);
        let here = straight.states[0].node.place_m;
        let (mut off, mut all) = (0.0, 0.0);
        for seconds in [15.0, 28.0, 50.0, 85.0] {
            for i in 0..24 {
                let behind = seconds * speed;
                let place = DVec2::new(-behind, 0.017 * f64::from(i) * behind);
                let (found, wanted) = (height(&straight, here + place), integral(&hull, place));
                off += (found - wanted).powi(2);
                all += wanted * wanted;
            }
        }
        let share = (off / all).sqrt();
        println!("{speed} m/s: {share:.3} of the root mean square height");
        assert!(share < 0.1, "{speed}: {share}");
    }
}

#[test]
fn waves_fall_with_the_root_of_the_way_and_at_the_cusps_with_its_cube_root() {
    let hull = slender(6.0, 0.0);
    let straight = wake(hull, 1e4);
    let here = straight.states[0].node.place_m;
    // Largest height over a wave length around a distance, along a ray.
    let largest = |behind: f64, slope: f64| {
        (0..400)
            .map(|i| behind + 0.1 * f64::from(i))
            .map(|x| height(&straight, here + DVec2::new(-x, slope * x)).abs())
            .fold(0.0, f64::max)
    };
    let near_cusps = |behind: f64| (0..30).map(|i| largest(behind, 0.3 + 0.002 * f64::from(i))).fold(0.0, f64::max);
    for (heights, exponent) in [
        ([150.0, 450.0].map(|behind| largest(behind, 0.05)), super::super::wake::INSIDE_DECAY),
        ([150.0, 450.0].map(near_cusps), super::super::wake::CUSP_DECAY),
    ] {
        let found = libm::log(heights[1] / heights[0]) / libm::log(3.0);
        println!("{found:.3} for {exponent:.3}");
        assert!((found - exponent).abs() < 0.05, "{found} {exponent}");
    }
    // Beyond the wedge there is nothing.
    assert!(largest(400.0, 0.6) < 1e-3 * largest(400.0, 0.3536));
}

#[test]
fn fast_hulls_are_highest_inside_the_wedge() {
    for froude in [0.6, 0.8, 1.0, 1.5] {
        let speed = froude * (GRAVITY_M_S2 * 30.0f64).sqrt();
        let fast = wake(SeaHull { beam_m: 8.0, draught_m: 0.01, ..slender(speed, 0.0) }, 1e4);
        let here = fast.states[0].node.place_m;
        let energy = |deg: f64| -> f64 {
            let slope = deg.to_radians().tan();
            let at = |i: i32| speed * (60.0 + 0.2 * f64::from(i));
            (0..100).map(|i| height(&fast, here + DVec2::new(-at(i), slope * at(i))).powi(2)).sum()
        };
        let best = (10..60).map(|i| 0.4 * f64::from(i)).max_by(|a, b| energy(*a).total_cmp(&energy(*b))).unwrap();
        let wanted = super::super::wake::highest_angle(froude).to_degrees();
        println!("Froude {froude}: {best:.1} for {wanted:.1}");
        assert!((best - wanted).abs() < 2.5, "{froude}: {best} {wanted}");
    }
}

#[test]
fn turning_wakes_are_mirrored_and_have_no_steps() {
    let [right, left] = [2.5, -2.5].map(|turn| wake(slender(6.0, turn), 90.0));
    let (mut before, mut steps, mut most) = (0.0, Vec::new(), 0.0f64);
    for i in 0..60_000 {
        // Straight ways over the inner side and the outer one.
        let place = DVec2::new(-60.0, 130.0) + DVec2::new(0.0, -0.01 * f64::from(i));
        let h = height(&right, place);
        let mirrored = height(&left, DVec2::new(place.x, -place.y));
        assert!((h - mirrored).abs() < 1e-9, "{place}: {h} {mirrored}");
        if i > 0 {
            steps.push((h - before).abs());
        }
        most = most.max(h.abs());
        before = h;
    }
    steps.sort_by(f64::total_cmp);
    let (usual, largest) = (steps[steps.len() * 99 / 100], steps[steps.len() - 1]);
    println!("highest {most:.4} m, steps of 1 cm: 99 % within {usual:.6} m, the largest {largest:.6} m");
    assert!(most > 1e-3 && largest < 0.04 * most, "{largest} {most}");
}

#[test]
fn hulls_at_rest_raise_nothing_and_short_waves_can_be_left_out() {
    assert_eq!(height(&wake(SeaHull { speed_m_s: 0.5, ..slender(0.0, 0.0) }, 100.0), DVec2::new(20.0, 3.0)), 0.0);
    let hull = SeaHull { heading_deg: 90.0, speed_m_s: 6.0, ..SeaHull::default() };
    let made = wake(hull, 300.0);
    let place = made.states[0].node.place_m + DVec2::new(-180.0, 57.0);
    let mut all = WakePoint::default();
    made.add_at(place, 0.0, &mut all);
    for shortest in [5.0, 20.0, 100.0] {
        let mut long = WakePoint::default();
        made.add_at(place, shortest, &mut long);
        assert!((all.height_m - long.height_m).abs() <= long.left_out_m + 1e-12, "{shortest}");
    }
    // The slope is that of the height, the velocity that of its change.
    let h = 1e-3;
    let slope = [DVec2::X, DVec2::Y]
        .map(|axis| (height(&made, place + axis * h) - height(&made, place - axis * h)) / (2.0 * h));
    assert!((DVec2::from(slope) - all.slope).length() < 0.15 * all.slope.length(), "{slope:?} {}", all.slope);
    let [later, earlier] = [300.0 + h, 300.0 - h].map(|time_s| height(&wake(hull, time_s), place));
    let rising = (later - earlier) / (2.0 * h);
    assert!(
        (rising - all.velocity_m_s.z).abs() < 0.05 * all.velocity_m_s.length() + 1e-3,
        "{rising} {}",
        all.velocity_m_s
    );
}

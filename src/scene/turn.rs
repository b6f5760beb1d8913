//! Rotations and angles computed by `libm`, so that a state has the same bits on every machine.

use glam::{DMat3, DVec3};

/// Returns the rotation by an angle about the x axis. It has the same bits on every machine, which glam's does not
/// promise.
pub(crate) fn turn_x(angle: f64) -> DMat3 {
    let (s, c) = libm::sincos(angle);
    DMat3::from_cols(DVec3::X, DVec3::new(0.0, c, s), DVec3::new(0.0, -s, c))
}

/// Returns the rotation about the y axis, as [`turn_x`].
pub(crate) fn turn_y(angle: f64) -> DMat3 {
    let (s, c) = libm::sincos(angle);
    DMat3::from_cols(DVec3::new(c, 0.0, -s), DVec3::Y, DVec3::new(s, 0.0, c))
}

/// Returns the rotation about the z axis, as [`turn_x`].
pub(crate) fn turn_z(angle: f64) -> DMat3 {
    let (s, c) = libm::sincos(angle);
    DMat3::from_cols(DVec3::new(c, s, 0.0), DVec3::new(-s, c, 0.0), DVec3::Z)
}

/// Returns the angle between two directions, with the same bits on every machine.
pub(crate) fn angle_between(a: DVec3, b: DVec3) -> f64 {
    libm::acos((a.dot(b) / (a.length_squared() * b.length_squared()).sqrt()).clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_are_those_of_glam() {
        for angle in [-7.0, -0.3, 0.0, 1e-9, 2.5, 100.0] {
            let pairs = [
                (turn_x(angle), DMat3::from_rotation_x(angle)),
                (turn_y(angle), DMat3::from_rotation_y(angle)),
                (turn_z(angle), DMat3::from_rotation_z(angle)),
            ];
            for (own, glam) in pairs {
                assert!((own - glam).to_cols_array().iter().all(|v| v.abs() < 1e-15), "{angle}: {own} {glam}");
            }
            let turned = turn_z(angle) * DVec3::X;
            assert!((angle_between(2.0 * DVec3::X, 3.0 * turned) - libm::acos(libm::cos(angle))).abs() < 1e-7);
        }
    }
}

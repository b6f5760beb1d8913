//! Six sides of the box: the ghost values beyond them, and the air that passes them.

use super::lattice::{Faces, Lattice};

/// Kind of a side of the box.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Side {
    /// Open side. If the outer wind blows in over the side as a whole, air comes in with this wind. If it blows out,
    /// air leaves with the velocity that advection gives it. The pressure does not change this velocity. To balance the
    /// flux, the same change of speed is added at all outflow faces. If the wind blows neither in nor out, the side is
    /// a slip wall.
    #[default]
    Open,
    /// Wall along which air slides without friction.
    Slip,
    /// Wall at which air has the wall's velocity, m/s; the component through the wall is ignored.
    NoSlip([f32; 3]),
    /// Side whose outflow comes in on the opposite side, which must be periodic too.
    Periodic,
}

/// Present effect of a side on the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// Periodic: what leaves comes in on the opposite side.
    Periodic,
    /// Wall along which air slides without friction.
    Slip,
    /// Wall at which air has the wall's velocity, m/s (east, north, up).
    NoSlip([f32; 3]),
    /// Inflow: air has the velocity of the outer wind.
    In,
    /// Outflow: air leaves with the velocity that advection gives it.
    Out,
}

/// Roles of the low and the high side of each axis.
pub(super) type Roles = [[Role; 2]; 3];

/// Least mean flow through an open side, as a share of the wind's speed. With less, the side is a wall.
const LEAST_THROUGH: f64 = 1e-4;

/// Returns the roles of the sides in the outer wind `outer`.
pub(super) fn roles(lattice: &Lattice, sides: &[[Side; 2]; 3], outer: &Faces) -> Roles {
    let mut roles = [[Role::Periodic; 2]; 3];
    let fastest = fastest_on_sides(lattice, outer);
    for axis in 0..3 {
        for end in 0..2 {
            roles[axis][end] = match sides[axis][end] {
                _ if lattice.is_flat(axis) => Role::Periodic,
                Side::Periodic => Role::Periodic,
                Side::Slip => Role::Slip,
                Side::NoSlip(v) => Role::NoSlip(v),
                Side::Open => {
                    let outward = mean_through(lattice, outer, axis, end) * if end == 0 { -1.0 } else { 1.0 };
                    match outward {
                        v if v < -LEAST_THROUGH * fastest => Role::In,
                        v if v > LEAST_THROUGH * fastest => Role::Out,
                        _ => Role::Slip,
                    }
                }
            };
        }
    }
    roles
}

/// Returns the largest component on any face on a side or next to it, m/s. Further inside, `outer` still has the wind
/// with which the field was created.
fn fastest_on_sides(lattice: &Lattice, outer: &Faces) -> f64 {
    let mut most = 0.0_f32;
    for c in lattice.axes() {
        lattice.each_on_sides(c, |_, at| most = most.max(outer[c][at].abs()));
    }
    most.into()
}

/// Returns the largest component on any face, m/s.
pub(super) fn fastest(lattice: &Lattice, faces: &Faces) -> f64 {
    let mut most = 0.0_f32;
    for c in lattice.axes() {
        lattice.each(c, |_, at| most = most.max(faces[c][at].abs()));
    }
    most.into()
}

/// Returns the mean velocity through a side along its axis, m/s; `end` is 0 for the low side, 1 for the high one.
fn mean_through(lattice: &Lattice, outer: &Faces, axis: usize, end: usize) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    let face = if end == 0 { 0 } else { lattice.n[axis] };
    lattice.each(axis, |i, at| {
        if i[axis] == face {
            sum += f64::from(outer[axis][at]);
            count += 1.0;
        }
    });
    sum / count
}

/// Fills the ghosts of a component, and its faces on the sides.
pub(super) fn fill(lattice: &Lattice, roles: &Roles, outer: &Faces, component: usize, values: &mut [f32]) {
    for axis in lattice.axes() {
        let n = lattice.n[axis] as isize;
        let stride = lattice.stride[axis] as isize;
        let outer = &outer[component];
        let across = component == axis;
        lattice.each_line(axis, |first| {
            let at = |i: isize| (first as isize + i * stride) as usize;
            for (end, role) in roles[axis].into_iter().enumerate() {
                // Index counted inward from the side, from 0 for faces and for values between faces.
                let edge = if across { n } else { n - 1 };
                let inward = |i: isize| at(if end == 0 { i } else { edge - i });
                match role {
                    Role::Periodic => {
                        if across && end == 1 {
                            values[at(n)] = values[at(0)];
                        }
                        for g in 1..=2 {
                            let from = if across { g } else { g - 1 };
                            values[inward(-g)] = values[if end == 0 { at(n - g) } else { at(from % n) }];
                        }
                    }
                    Role::Slip | Role::NoSlip(_) if across => {
                        values[inward(0)] = 0.0;
                        for g in 1..=2 {
                            values[inward(-g)] = -values[inward(g.min(edge))];
                        }
                    }
                    Role::Slip => (1..=2).for_each(|g| values[inward(-g)] = values[inward((g - 1).min(edge))]),
                    Role::NoSlip(wall) => {
                        (1..=2).for_each(|g| {
                            values[inward(-g)] = 2.0 * wall[component] - values[inward((g - 1).min(edge))]
                        });
                    }
                    Role::In => (if across { 0 } else { 1 }..=2).for_each(|g| values[inward(-g)] = outer[inward(-g)]),
                    Role::Out => (1..=2).for_each(|g| values[inward(-g)] = values[inward(0)]),
                }
            }
        });
    }
}

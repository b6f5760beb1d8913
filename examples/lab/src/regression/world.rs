//! The world in a scene's host: a yard or hills, found by a ray for each pixel, and their light.

use glam::{DMat3, DVec2, DVec3};
use welkin::{
    ground::{GroundGrid, SurfaceClass},
    rain::{Planes, Shelter},
};

/// The surroundings of the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum World {
    /// A plain with a road and boxes.
    #[default]
    Yard,
    /// Hills with a road through them.
    Hills,
    /// Nothing at all.
    Nothing,
}

/// End of a ray, east, north and up of the world's origin, with the normal and the material there.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    pub at: DVec3,
    pub normal: DVec3,
    pub class: SurfaceClass,
}

/// Boxes of the yard: centre and half size, m. The first is a roof without supports.
const BOXES: [([f64; 3], [f64; 3]); 5] = [
    ([-3.5, 9.0, 3.2], [2.5, 3.0, 0.15]),
    ([6.0, 16.0, 1.5], [1.5, 1.5, 1.5]),
    ([-14.0, 45.0, 6.0], [5.0, 4.0, 6.0]),
    ([45.0, 160.0, 12.0], [10.0, 8.0, 12.0]),
    ([-150.0, 900.0, 40.0], [40.0, 20.0, 40.0]),
];
const NODES: u32 = 65;
const CELL_M: f64 = 25.0;

/// The yard's boxes as shelters from rain.
pub fn shelters() -> Vec<Shelter> {
    let shelter = |(center, half): ([f64; 3], [f64; 3])| Shelter {
        center_m: DVec3::from(center),
        axes: DMat3::IDENTITY,
        half_size_m: DVec3::from(half),
        velocity_m_s: DVec3::ZERO,
        planes: Planes::NONE,
    };
    BOXES.map(shelter).to_vec()
}

/// Height of the hills, m: 0 along a road that runs east at y = 200.
fn height(at: DVec2) -> f64 {
    let off_road = 1.0 - (-(at.y - 200.0).powi(2) / (2.0 * 60.0f64.powi(2))).exp();
    off_road * (18.0 * (at.x / 90.0 + 0.8).sin() * (at.y / 120.0).sin() + 22.0)
}

fn hill_class(at: DVec2) -> SurfaceClass {
    if (at.y - 200.0).abs() < 25.0 {
        SurfaceClass::Paved
    } else if at.x < -60.0 {
        SurfaceClass::Rock
    } else if at.x < 60.0 {
        SurfaceClass::Soil
    } else {
        SurfaceClass::Vegetation
    }
}

/// The hills as the grid that a host provides for water on the ground.
pub fn hill_grid() -> GroundGrid {
    let corner = DVec2::new(-0.5 * f64::from(NODES - 1) * CELL_M, -200.0);
    let nodes = || (0..NODES * NODES).map(|i| corner + DVec2::new(f64::from(i % NODES), f64::from(i / NODES)) * CELL_M);
    GroundGrid {
        origin: corner.extend(0.0),
        cell_m: CELL_M,
        nodes: [NODES; 2],
        heights_m: nodes().map(|at| height(at) as f32).collect(),
        classes: nodes().map(hill_class).collect(),
    }
}

fn hills(eye: DVec3, d: DVec3) -> Option<Hit> {
    let above = |t: f64| {
        let p = eye + d * t;
        p.z - height(p.truncate())
    };
    let (mut near, mut far) = (0.0, 0.0);
    while far < 4000.0 {
        (near, far) = (far, far + 0.4 + 0.01 * far);
        if above(far) < 0.0 {
            break;
        }
    }
    if above(far) >= 0.0 {
        return None;
    }
    for _ in 0..40 {
        let middle = 0.5 * (near + far);
        if above(middle) < 0.0 { far = middle } else { near = middle }
    }
    let at = eye + d * far;
    let rise = |s: DVec2| height(at.truncate() + s) - height(at.truncate() - s);
    let normal = DVec3::new(-rise(DVec2::X), -rise(DVec2::Y), 2.0).normalize();
    Some(Hit { at, normal, class: hill_class(at.truncate()) })
}

fn yard(eye: DVec3, d: DVec3) -> Option<Hit> {
    let mut best: Option<(f64, DVec3, SurfaceClass)> = None;
    if d.z < -1e-9 && eye.z > 0.0 {
        let t = -eye.z / d.z;
        let p = eye + d * t;
        let class = if (p.x - 0.5).abs() < 3.5 { SurfaceClass::Paved } else { SurfaceClass::Vegetation };
        best = (t < 30_000.0).then_some((t, DVec3::Z, class));
    }
    for (center, half) in BOXES {
        let half = DVec3::from(half);
        let (o, e) = ((eye - DVec3::from(center)) / half, d / half);
        let (mut near, mut far, mut axis) = (0.0f64, f64::INFINITY, 0);
        for i in 0..3 {
            let (a, b) = ((-1.0 - o[i]) / e[i], (1.0 - o[i]) / e[i]);
            if a.min(b) > near {
                (near, axis) = (a.min(b), i);
            }
            far = far.min(a.max(b));
        }
        if far > near && near > 0.0 && best.is_none_or(|(t, ..)| near < t) {
            let mut normal = DVec3::ZERO;
            normal[axis] = -e[axis].signum();
            best = Some((near, normal, SurfaceClass::Building));
        }
    }
    best.map(|(t, normal, class)| Hit { at: eye + d * t, normal, class })
}

impl World {
    /// Casts a ray from `eye` along the unit vector `d`, both east, north, up.
    pub fn cast(self, eye: DVec3, d: DVec3) -> Option<Hit> {
        match self {
            Self::Yard => yard(eye, d),
            Self::Hills => hills(eye, d),
            Self::Nothing => None,
        }
    }
}

/// Albedo of a hit, linear Rec. 709: its material with a pattern at a scale of metres.
pub fn albedo(hit: &Hit) -> [f64; 3] {
    let base = match hit.class {
        SurfaceClass::Paved => [0.11, 0.11, 0.11],
        SurfaceClass::Vegetation => [0.09, 0.16, 0.05],
        SurfaceClass::Rock => [0.3, 0.28, 0.25],
        SurfaceClass::Building => [0.5, 0.35, 0.28],
        _ => [0.22, 0.16, 0.11],
    };
    let cell = (hit.at / 2.0).floor();
    let spot = if (cell.x + cell.y + cell.z).rem_euclid(2.0) < 1.0 { 1.15 } else { 0.85 };
    base.map(|a| a * spot)
}

/// Illuminance of a surface from the host's own simple model, lux: the sun on the slope and a uniform sky, or the
/// night's. `deck` is the largest cover of any cloud layer.
pub fn illuminance(normal: DVec3, to_light: DVec3, night: bool, deck: f64) -> f64 {
    let open = 0.5 + 0.5 * normal.z;
    let clear = 1.0 - 0.9 * deck.powi(2);
    if night {
        return 0.05 * clear * normal.dot(to_light).max(0.0) + 2e-3 * open;
    }
    let height = to_light.z.max(0.0);
    9e4 * clear.powi(2) * height * normal.dot(to_light).max(0.0) + (200.0 + 2e4 * height) * (0.2 + 0.8 * clear) * open
}

//! Tests that groups of values give the bits of one value after another.

use glam::{DVec2, DVec3, dvec3};

use super::{
    super::{
        lanes::Carrier,
        lattice::{Faces, GHOSTS, Lattice},
    },
    *,
};
use crate::chance::RandomStream;

/// The pressure equation in the order of cells.
struct PlainGrid {
    n: [usize; 3],
    lower: [Vec<f32>; 3],
}

impl PlainGrid {
    /// An equation with cells without air, whose axes wrap or not.
    fn new(n: [usize; 3], wraps: bool, random: &mut RandomStream) -> Self {
        let count: usize = n.iter().product();
        let solid: Vec<bool> = (0..count).map(|_| random.unit() < 0.2).collect();
        let mut lower = [0, 1, 2].map(|_| vec![0.0; count]);
        for cell in 0..count {
            for a in (0..3).filter(|a| n[*a] > 1) {
                let is_first = Self::place(n, cell)[a] == 0;
                let closed = solid[cell] || solid[Self::beside(n, cell, a, false)];
                lower[a][cell] = if closed || (is_first && !wraps) { 0.0 } else { random.unit() as f32 };
            }
        }
        Self { n, lower }
    }

    fn place([x, y, _]: [usize; 3], cell: usize) -> [usize; 3] {
        [cell % x, cell / x % y, cell / (x * y)]
    }

    fn beside(n: [usize; 3], cell: usize, axis: usize, is_up: bool) -> usize {
        let mut i = Self::place(n, cell);
        i[axis] = (i[axis] + if is_up { 1 } else { n[axis] - 1 }) % n[axis];
        (i[2] * n[1] + i[1]) * n[0] + i[0]
    }

    fn sums(&self, cell: usize, x: &[f32]) -> [f32; 2] {
        let terms = [0, 1, 2].map(|a| {
            let (low, high) = (Self::beside(self.n, cell, a, false), Self::beside(self.n, cell, a, true));
            let [own, next] = [self.lower[a][cell], self.lower[a][high]];
            ([own * x[low], next * x[high]], [own, next])
        });
        let [x, y, z] = terms;
        let sum = x.0[0] + x.0[1] + y.0[0] + y.0[1] + z.0[0] + z.0[1];
        [sum, (x.1[0] + x.1[1]) + (y.1[0] + y.1[1]) + z.1[0] + z.1[1]]
    }

    fn relax(&self, x: &mut [f32], b: &[f32], relaxation: f32, colour: usize) {
        for cell in 0..x.len() {
            let [sum, all] = self.sums(cell, x);
            if Self::place(self.n, cell).iter().sum::<usize>() % 2 == colour && all > 0.0 {
                x[cell] += relaxation * ((sum - b[cell]) / all - x[cell]);
            }
        }
    }

    fn residual(&self, x: &[f32], b: &[f32]) -> Vec<f32> {
        let of = |cell: usize| {
            let [sum, all] = self.sums(cell, x);
            b[cell] - (sum - all * x[cell])
        };
        (0..x.len()).map(of).collect()
    }
}

#[test]
fn sweeps_over_halves_of_rows_are_sweeps_over_cells() {
    let mut random = RandomStream::new(7, 1);
    let sizes = [[8, 8, 8], [16, 3, 2], [9, 7, 5], [5, 4, 3], [3, 3, 3], [2, 2, 1], [1, 5, 4], [31, 1, 6], [34, 5, 3]];
    for (n, wraps) in sizes.into_iter().flat_map(|n| [(n, false), (n, true)]) {
        let plain = PlainGrid::new(n, wraps, &mut random);
        let mut level = GridLevel::new(n, [1.0; 3], plain.lower.clone());
        let (halves, count) = (level.halves, n.iter().product());
        let mut cells = || (0..count).map(|_| random.unit() as f32 - 0.5).collect::<Vec<_>>();
        let (mut x, b) = (vec![0.0; count], cells());
        let [mut own_x, mut own_b, mut r] = [0; 3].map(|_| vec![0.0; halves.len()]);
        halves.put(&b, &mut own_b);
        let mut back = vec![0.0; count];
        for (relaxation, colour) in [(1.0, 0), (1.0, 1), (1.7, 0), (1.1, 1), (1.0, 0), (1.3, 1)] {
            plain.relax(&mut x, &b, relaxation, colour);
            level.relax(&mut own_x, &own_b, relaxation, colour);
            halves.get(&own_x, &mut back);
            assert_eq!(back, x, "{n:?}, wraps: {wraps}");
        }
        level.residual(&own_x, &own_b, &mut r);
        halves.get(&r, &mut back);
        assert_eq!(back, plain.residual(&x, &b), "{n:?}, wraps: {wraps}");
        let air: Vec<bool> = (0..count).map(|cell| plain.sums(cell, &x)[1] > 0.0).collect();
        assert_eq!(level.air(), air);
    }
}

/// Value of a component where air came from along a curved path: by Lagrange's cubic, limited to its nearest values.
fn carried(lattice: &Lattice, wind: &Faces, source: &Faces, c: usize, i: [usize; 3], dt: f32) -> f32 {
    let axes = |a: usize| !lattice.is_flat(a);
    let low = |component: usize, place: [f32; 3]| {
        [0, 1, 2].map(|a| {
            let p = place[a] + GHOSTS as f32 - if a == component { 0.0 } else { 0.5 };
            if axes(a) { (p as usize, p - (p as usize) as f32) } else { (0, 0.0) }
        })
    };
    let position = |i: [usize; 3]| (0..3).map(|a| i[a] * lattice.stride[a]).sum::<usize>();
    let linear = |component: usize, place: [f32; 3]| {
        let [x, y, z] = low(component, place);
        let v = |dx: usize, dy: usize, dz: usize| wind[component][position([x.0 + dx, y.0 + dy, z.0 + dz])];
        let row = |dy, dz| v(0, dy, dz) + (v(1, dy, dz) - v(0, dy, dz)) * x.1;
        let layer = |dz| row(0, dz) + (row(1, dz) - row(0, dz)) * y.1;
        layer(0) + (layer(1) - layer(0)) * z.1
    };
    let velocity = |place: [f32; 3]| [0, 1, 2].map(|a| linear(a, place));
    let moved = |way: [f32; 3], far: f32| {
        let place = lattice.place(c, i);
        [0, 1, 2].map(|a| (place[a] + far * (1.0 / lattice.h[a]) * way[a]).max(0.0).min(lattice.n[a] as f32))
    };
    let v1 = velocity(lattice.place(c, i));
    let v2 = velocity(moved(v1, 0.5 * -dt));
    let v3 = velocity(moved(v2, 0.75 * -dt));
    let mean = [0, 1, 2].map(|a| (2.0 * v1[a] + 3.0 * v2[a] + 4.0 * v3[a]) / 9.0);
    let [x, y, z] = low(c, moved(mean, -dt));
    let v = |dx: usize, dy: usize, dz: usize| source[c][position([x.0 + dx - 1, y.0 + dy - 1, z.0 + dz - 1])];
    let weights = |f: f32| {
        let (a, b, c) = (f + 1.0, f - 1.0, f - 2.0);
        [-f * b * c / 6.0, a * b * c / 2.0, -a * f * c / 2.0, a * f * b / 6.0]
    };
    let sum = |w: [f32; 4], v: [f32; 4]| w[0] * v[0] + w[1] * v[1] + w[2] * v[2] + w[3] * v[3];
    let all = [0, 1, 2, 3];
    let row = |dy, dz| sum(weights(x.1), all.map(|dx| v(dx, dy, dz)));
    let cubic = sum(weights(z.1), all.map(|dz| sum(weights(y.1), all.map(|dy| row(dy, dz)))));
    let near = [1, 2].into_iter().flat_map(|dz| [1, 2].into_iter().flat_map(move |dy| [1, 2].map(|dx| [dx, dy, dz])));
    let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
    for [dx, dy, dz] in near {
        (least, most) = (least.min(v(dx, dy, dz)), most.max(v(dx, dy, dz)));
    }
    cubic.max(least).min(most)
}

#[test]
fn four_faces_at_once_are_carried_as_each_alone() {
    let mut random = RandomStream::new(8, 1);
    // Air that comes from neighbouring places, and air that does not.
    for (n, rough) in [([13, 6, 5], 0.0), ([13, 6, 5], 20.0), ([8, 8, 8], 3.0), ([2, 3, 4], 9.0)] {
        let lattice = Lattice::new(n, dvec3(2.0, 1.5, 1.0)).expect("a lattice");
        let mut faces = |rough: f64| {
            let mut faces = lattice.zeros();
            for c in 0..3 {
                let mean = [3.0, -1.0, 0.3][c];
                lattice.each_with_ghosts(c, |_, at| faces[c][at] = (mean + rough * (random.unit() - 0.5)) as f32);
            }
            faces
        };
        let (wind, source) = (faces(rough), faces(2.0));
        let range = [0, 1, 2].map(|a| Some([0.0, lattice.n[a] as f32]));
        let mut target = lattice.zeros();
        Carrier::new(&lattice, &wind, range).cubic(&source, 0.7, &mut target);
        for c in lattice.axes() {
            lattice.each(c, |i, at| {
                let alone = carried(&lattice, &wind, &source, c, i, 0.7);
                assert_eq!(target[c][at], alone, "{n:?}, rough {rough}, component {c} at {i:?}");
            });
        }
    }
}

/// Hash of all numbers of a field after some steps.
fn hash_after(settings: &FlowSettings, boxes: &[FlowBox], terrain: Option<Heights>) -> u64 {
    let wind = |p: DVec3| dvec3(6.0 + 0.1 * p.z - 0.02 * p.y, 2.0 + 0.03 * p.x, 0.0);
    let mut field = field(settings, &FlowObstacles { terrain, boxes }, wind);
    for _ in 0..4 {
        field.step(0.4).expect("a step");
    }
    let numbers = field.numbers().flatten().flat_map(|v| v.to_bits().to_le_bytes());
    numbers.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// Saved states and channels rely on these: who changes a bit of the solver gives it another name in the state.
#[test]
fn the_solver_of_this_name_has_these_bits() {
    let cell_m = dvec3(2.0, 2.0, 1.5);
    let wind = FlowSettings { cells: [30, 21, 14], cell_m, tolerance: 1e-3, ..Default::default() };
    let weather = FlowSettings { has_eddies: true, roughness_m: 0.03, ..wind };
    let round = [[Side::Periodic; 2], [Side::Periodic; 2], [Side::Slip; 2]];
    let boxes = [
        FlowBox {
            velocity_m_s: dvec3(1.0, 0.5, 0.0),
            ..FlowBox::level(dvec3(20.3, 25.1, 4.0), dvec3(5.0, 4.0, 8.0), 0.0)
        },
        FlowBox::level(dvec3(42.0, 20.0, 3.0), dvec3(0.2, 12.0, 6.5), 0.0),
    ];
    let slope = |p: DVec2| 0.5 + 0.02 * p.x + 0.001 * p.y * p.y;
    let sor = PressureMethod::Sor { relaxation: [1.7, 1.1], max_iterations: 40 };
    let scenes = [
        (weather, 0x6bf1_207a_df48_23ad_u64),
        (FlowSettings { scheme: Scheme::MacCormack, ..weather }, 0x762d_1da3_2c08_5653),
        (FlowSettings { scheme: Scheme::SemiLagrangian, pressure: sor, ..weather }, 0xc1dd_59c1_a2fc_2aed),
        (FlowSettings { cells: [33, 21, 9], sides: round, ..wind }, 0x1c92_5faa_42a4_3bca),
        (FlowSettings { cells: [25, 16, 1], viscosity_m2_s: 0.3, is_slip: false, ..weather }, 0x951b_a90d_7a24_b06b),
        (FlowSettings { cell_m: dvec3(8.0, 2.0, 1.5), tolerance: 1e-6, ..weather }, 0x5a2f_68ef_eb3e_43cc),
    ];
    for (i, (settings, hash)) in scenes.into_iter().enumerate() {
        let found = hash_after(&settings, &boxes, Some(&slope));
        println!("{i}: 0x{found:016x}");
        assert_eq!(found, hash, "scene {i}");
    }
}

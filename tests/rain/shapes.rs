//! Boxes cut by planes to other convex shapes, against their f64 reference: where rain falls round them and where it
//! does not.

use glam::{DMat3, DVec3};
use welkin::rain::{Planes, Shelter};
use welkin_support::rain_scene::{rain, upright};

use crate::shelter::{check, few, through, white};

/// A gable roof in the air, a tent on the ground, and a moving cab with a slanted front.
fn shapes() -> Vec<Shelter> {
    let slope = DVec3::new(0.0, 2.0, 3.0).normalize();
    let gable = Planes::new(&[[0.0, slope.y, slope.z, slope.z], [0.0, -slope.y, slope.z, slope.z]]).unwrap();
    // Four faces that meet 2 m above the middle of its box.
    let tent: Vec<[f64; 4]> = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]]
        .map(|[x, y]| DVec3::new(2.0 * x, 2.0 * y, 1.5).normalize())
        .map(|n| n.extend(2.0 * n.z).to_array())
        .to_vec();
    let front = DVec3::new(0.0, 0.8, 0.6);
    let cab = Planes::new(&[front.extend(0.9).to_array(), [0.6, 0.0, 0.8, 1.1], [-0.6, 0.0, 0.8, 1.1]]).unwrap();
    vec![
        Shelter { axes: DMat3::from_rotation_z(0.5), planes: gable, ..upright([-2.5, 6.0, 4.5], [3.0, 3.0, 1.0]) },
        Shelter { planes: Planes::new(&tent).unwrap(), ..upright([3.0, 4.5, 2.0], [3.0, 3.0, 2.0]) },
        Shelter { velocity_m_s: DVec3::Y * 12.0, planes: cab, ..upright([0.3, 2.5, 1.5], [1.2, 1.6, 1.5]) },
    ]
}

#[test]
fn no_drop_is_drawn_that_a_cut_box_keeps_off_and_all_others_are() {
    let mut host = white((480, 270));
    let shapes = shapes();
    for (i, wind) in [0.0, 5.0, 12.0, 25.0].into_iter().enumerate() {
        let classes = few(&mut host, 10.0, wind, 10.0 * (i + 1) as f64);
        host.context.set_shelters(&shapes).unwrap();
        let whole: Vec<Shelter> = shapes.iter().map(|s| Shelter { planes: Planes::NONE, ..*s }).collect();
        let (mut dry, mut drawn) = (0, 0);
        for (from, to) in [
            ([0.5, -1.0, 1.7], [0.0, 1.0, -0.1]),
            ([0.0, 3.0, 1.2], [-0.4, 1.0, 0.3]),
            ([3.0, 1.0, 1.0], [0.0, 1.0, 0.2]),
        ] {
            host.look(DVec3::from(from), DVec3::from(to));
            let (a, b) = check(&mut host, (&[], &shapes), &classes, 0.02, &format!("wind {wind}"));
            (dry, drawn) = (dry + a, drawn + b);
        }
        println!("wind {wind}: {dry} drops kept off, {drawn} drawn");
        assert!(dry > 30 && drawn > 30, "wind {wind}: {dry} {drawn}");
        // The uncut boxes keep more rain off.
        let cut = through(&mut host, &[]);
        host.context.set_shelters(&whole).unwrap();
        let dark = |pixels: &[f64]| pixels.iter().map(|v| 1.0 - v).sum::<f64>();
        let (cut, whole) = (dark(&cut), dark(&through(&mut host, &[])));
        assert!(whole < 0.95 * cut, "wind {wind}: {whole} of {cut}");
    }
}

#[test]
fn it_is_dry_in_a_cab_of_any_convex_shape_and_as_before_when_the_planes_are_gone() {
    let mut host = white((160, 90));
    host.context.set_weather(&rain(100.0, 8.0), 10.0, 0.0).unwrap();
    host.context.update(12.0).unwrap();
    let eye = DVec3::new(0.0, 0.0, 30.0);
    host.look(eye, DVec3::Y);
    host.velocity_m_s = DVec3::Y * 20.0;
    // A prism of eight sides that contains all drawn drops.
    let sides: Vec<[f64; 4]> = (0..8)
        .map(|i| f64::from(i) * std::f64::consts::FRAC_PI_4 + 0.3)
        .map(|a| [a.cos(), a.sin(), 0.0, 4.2])
        .collect();
    let room = |planes| Shelter { velocity_m_s: DVec3::Y * 20.0, planes, ..upright(eye.to_array(), [6.0; 3]) };
    host.context.set_shelters(&[room(Planes::new(&sides).unwrap())]).unwrap();
    assert!(through(&mut host, &[]).iter().all(|v| *v == 1.0), "inside");
    // The rest of the box after the cut lies behind the camera.
    host.context.set_shelters(&[room(Planes::new(&[[0.0, 1.0, 0.0, -4.5]]).unwrap())]).unwrap();
    let before = through(&mut host, &[]);
    host.context.set_shelters(&[]).unwrap();
    let open = through(&mut host, &[]);
    assert!(open.iter().any(|v| *v < 0.99), "it rains");
    assert_eq!(before, open, "rain that meets the camera head on does not come through what is behind it");
    host.context.set_shelters(&[room(Planes::NONE)]).unwrap();
    assert!(through(&mut host, &[]).iter().all(|v| *v == 1.0), "the whole box");
}

//! Stages of a frame: the pixels that each changes, their order, and refused calls.

use glam::DVec3;
use welkin::{
    Status,
    context::GivenDirection,
    frame::{CostItem, Frame, FrameFlags, Stages},
    scene::Camera,
};
use welkin_support::{
    frame_host::{Host, SIZE, camera},
    textures::texture,
};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

#[test]
fn background_fills_the_far_pixels_only_and_keeps_alpha() {
    let mut host = Host::new(FORMAT);
    host.clear([1.0, 2.0, 3.0, 0.5], 0.0);
    host.record(1, Stages::BACKGROUND).unwrap();
    let top = host.pixels()[0];
    assert!(top[2] > 100.0 && top[3] == 0.5, "the noon sky is bright and alpha is the host's: {top:?}");
    host.clear([1.0, 2.0, 3.0, 0.5], 0.01); // a wall 10 m away
    host.record(2, Stages::BACKGROUND).unwrap();
    assert_eq!(host.pixels()[0], [1.0, 2.0, 3.0, 0.5]);
}

#[test]
fn one_call_equals_the_stages_one_by_one() {
    let mut host = Host::new(FORMAT);
    for depth in [0.0, 1e-4] {
        host.clear([100.0, 2000.0, 300.0, 1.0], depth);
        host.record(1, Stages::ALL.without(Stages::TONE)).unwrap();
        let whole = host.pixels();
        host.clear([100.0, 2000.0, 300.0, 1.0], depth);
        for stage in [Stages::PREPARE, Stages::BACKGROUND, Stages::SURFACE, Stages::MEDIUM] {
            host.record(2, stage).unwrap();
        }
        for (a, b) in whole.iter().zip(host.pixels()) {
            for c in 0..3 {
                assert!((a[c] - b[c]).abs() <= 2e-3 * a[c].abs() + 0.5, "{a:?} {b:?}");
            }
        }
    }
}

#[test]
fn stages_out_of_order_and_unknown_bits_are_refused() {
    let mut host = Host::new(FORMAT);
    host.record(7, Stages::MEDIUM).unwrap();
    for stages in [Stages::BACKGROUND, Stages::MEDIUM] {
        assert_eq!(host.record(7, stages).unwrap_err().status, Status::WrongOrder);
    }
    host.record(7, Stages::TONE).unwrap();
    host.record(8, Stages::BACKGROUND).unwrap();
    for bits in [0, 128] {
        let e = host.record(9, Stages(bits)).unwrap_err();
        assert!(e.status == Status::InvalidArgument && e.to_string().contains("stages"), "{e}");
    }
}

#[test]
fn a_target_that_does_not_fit_is_refused_by_name() {
    let mut host = Host::new(FORMAT);
    let small = texture(&host.device, (SIZE.0, 8), wgpu::TextureFormat::Depth32Float, 1);
    let mut frame = Frame::new(1, camera(), &host.color, Some(&small));
    let e = host.view.record(&host.context, &frame, Stages::ALL).unwrap_err();
    assert!(e.to_string().contains("depth") && e.to_string().contains("160 x 90"), "{e}");
    frame.depth = None;
    frame.cd_m2_per_unit = f64::NAN;
    let e = host.view.record(&host.context, &frame, Stages::ALL).unwrap_err();
    assert!(e.to_string().contains("cd_m2_per_unit"), "{e}");
    frame.cd_m2_per_unit = 1.0;
    frame.color = None;
    let e = host.view.record(&host.context, &frame, Stages::ALL).unwrap_err();
    assert!(e.to_string().contains("color"), "{e}");
    host.view.record(&host.context, &frame, Stages::PREPARE).unwrap();
}

#[test]
fn a_measured_frame_says_what_each_effect_cost() {
    let mut host = Host::new(FORMAT);
    host.clear([100.0, 2000.0, 300.0, 1.0], 1e-4);
    host.record(1, Stages::ALL).unwrap();
    assert!(host.view.report().costs.is_none(), "who does not ask does not wait");
    let mut measured = |frame_id, stages| {
        let flags = FrameFlags::MEASURE;
        let frame = Frame { flags, ..Frame::new(frame_id, camera(), &host.color, Some(&host.depth)) };
        host.view.record(&host.context, &frame, stages).unwrap();
        host.view.report().costs.unwrap()
    };
    measured(2, Stages::ALL); // what is compiled at its first use
    let all = measured(3, Stages::ALL);
    let sum: f64 = CostItem::ALL.iter().map(|e| all.ms(*e)).sum();
    assert!((0.6..=1.1).contains(&(sum / all.whole_ms)), "{sum} of {} ms", all.whole_ms);
    for effect in [CostItem::Background, CostItem::Medium, CostItem::Tone] {
        assert!(all.ms(effect) > 0.0, "{effect:?}");
    }
    assert_eq!(all.ms(CostItem::SkyTables), 0.0, "nothing changed");
    let sky = measured(4, Stages::BACKGROUND);
    assert!(sky.ms(CostItem::Background) > 0.0 && sky.ms(CostItem::Medium) == 0.0 && sky.ms(CostItem::Tone) == 0.0);
    let both = measured(4, Stages::MEDIUM);
    assert!(both.ms(CostItem::Background) == sky.ms(CostItem::Background) && both.ms(CostItem::Medium) > 0.0);
    host.record(5, Stages::ALL).unwrap();
    assert!(host.view.report().costs.is_none());
    let mut encoder = host.device.device.create_command_encoder(&Default::default());
    let frame = Frame { flags: FrameFlags::MEASURE, ..Frame::new(6, camera(), &host.color, Some(&host.depth)) };
    let e = host.view.record_into(&host.context, &frame, Stages::ALL, &mut encoder).unwrap_err();
    assert!(e.status == Status::Unsupported && e.to_string().contains("MEASURE"), "{e}");
}

#[test]
fn a_low_sun_takes_no_colour_from_the_sky_round_it() {
    let mut host = Host::new(FORMAT);
    for (id, elevation_deg) in [0.5f64, 1.5, 3.0, 6.0, 20.0].into_iter().enumerate() {
        host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg })).unwrap();
        host.clear([0.0; 4], 0.0);
        let (up, north) = elevation_deg.to_radians().sin_cos();
        let (eye, forward) = (DVec3::new(0.0, 0.0, 50.0), DVec3::new(0.0, north, up));
        let camera = Camera::look_to(eye, forward, DVec3::Z, 0.5, 160.0 / 90.0, 0.1);
        let mut frame = Frame::new(id as u64, camera, &host.color, Some(&host.depth));
        frame.cd_m2_per_unit = 1e4; // the disc has 1e9 cd/m^2
        host.view.record(&host.context, &frame, Stages::BACKGROUND).unwrap();
        let pixels = host.pixels();
        let sky = pixels[(SIZE.1 / 2 * SIZE.0 + SIZE.0 / 2 + 8) as usize];
        // Refraction lifts the disc by some pixels.
        let disc: Vec<_> = pixels.iter().filter(|p| p[0] > 3.0 * sky[0]).collect();
        assert!(!disc.is_empty(), "sun {elevation_deg}");
        let whole = |pixel: &[f32; 4]| (0..3).all(|c| pixel[c] > 0.9 * sky[c]);
        assert!(disc.iter().all(|p| whole(p)), "sun {elevation_deg}: {disc:?} in {sky:?}");
    }
}

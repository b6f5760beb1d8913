//! The lens: within the pane, the host's pixels elsewhere, the scene upside down in the drops.

use glam::{DMat4, DVec3};
use welkin::{
    Status,
    frame::{CostItem, Frame, FrameFlags, Stages},
    glass::{Pane, Windscreen, WiperArm, laws::radius_m, step::VOLUME_UNIT_M3},
    scene::{Camera, DepthKind, DepthMapping},
};
use welkin_support::textures::texture;

use crate::host::{Host, camera, upright};

const SIZE: (u32, u32) = (320, 180);
const PLAIN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Returns the position of a point of the upright pane in the picture, pixels.
fn pixel([x, y]: [f64; 2]) -> [f64; 2] {
    let clip = camera().projection * DVec3::new(x - 0.2, y - 0.12, -0.3).extend(1.0);
    [(0.5 + 0.5 * clip.x / clip.w) * f64::from(SIZE.0), (0.5 - 0.5 * clip.y / clip.w) * f64::from(SIZE.1)]
}

#[test]
fn nothing_is_drawn_beside_the_pane_or_under_the_mask() {
    let mut host = Host::new(PLAIN, SIZE, 40.0);
    host.paint();
    let painted = host.pixels();
    // A pane over the left half of the picture, misted, so that every pixel of it changes.
    let corners = [(-0.4, -0.3), (0.0, -0.3), (0.0, 0.3), (-0.4, 0.3)].map(|(x, y)| DVec3::new(x, y, -0.3));
    let screen = Windscreen { pane: Pane::Quad(corners), fogging: 0.7, ..upright() };
    host.view.set_windscreen(Some(&screen)).unwrap();
    let mask = texture(&host.device, SIZE, PLAIN, 1);
    let rows: Vec<u8> = (0..SIZE.0 * SIZE.1).flat_map(|i| if i / SIZE.0 >= 120 { [255; 4] } else { [0; 4] }).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE.0), rows_per_image: None };
    host.device.queue.write_texture(mask.as_image_copy(), &rows, layout, mask.size());
    host.context.update(9.0).unwrap();
    let mut frame = Frame::new(1, camera(), &host.color, None);
    frame.color_space = welkin::frame::ColorSpace::DisplaySrgb;
    frame.mask = Some(&mask);
    host.view.record(&host.context, &frame, Stages::LENS).unwrap();
    let drawn = host.pixels();
    for (i, (a, b)) in painted.iter().zip(&drawn).enumerate() {
        let (x, y) = (i as u32 % SIZE.0, i as u32 / SIZE.0);
        if x >= 160 || y >= 120 {
            assert_eq!(a, b, "pixel {x} {y}");
        }
    }
    let changed = (0..painted.len()).filter(|i| painted[*i] != drawn[*i]).count();
    assert!(changed > 150 * 118, "{changed}");
}

#[test]
fn a_drop_shows_the_scene_upside_down() {
    let mut host = Host::new(PLAIN, SIZE, 60.0);
    host.view.set_windscreen(Some(&upright())).unwrap();
    host.at(40.0, Stages::PREPARE, FrameFlags(0)).unwrap();
    // Bright above, dark below.
    let bytes: Vec<u8> = (0..SIZE.0 * SIZE.1).flat_map(|i| if i / SIZE.0 < 90 { [230; 4] } else { [20; 4] }).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE.0), rows_per_image: None };
    host.device.queue.write_texture(host.color.as_image_copy(), &bytes, layout, host.color.size());
    host.at(40.0, Stages::LENS, FrameFlags(0)).unwrap();
    let (pixels, cells) = (host.pixels(), host.view.windscreen_cells().unwrap().unwrap());
    let (mut upper, mut lower, mut count) = (0.0, 0.0, 0);
    for (i, cell) in cells.cells.iter().enumerate() {
        let (x, y) = (i as u32 % cells.size[0], i as u32 / cells.size[0]);
        let at =
            [(x, cell[1] & 0xffff), (y, cell[1] >> 16)].map(|(n, f)| (f64::from(n) + f64::from(f) / 65536.0) * 0.004);
        let r = radius_m(f64::from(cell[0]) * VOLUME_UNIT_M3);
        // Beads of some size, not far from the horizon.
        if r < 0.0015 || (at[1] - 0.12).abs() > 0.05 {
            continue;
        }
        let value = |dy: f64| {
            let [px, py] = pixel([at[0], at[1] + dy * r]);
            f64::from(pixels[(py as u32 * SIZE.0 + px as u32) as usize][1])
        };
        (upper, lower, count) = (upper + value(0.6), lower + value(-0.6), count + 1);
    }
    let [upper, lower] = [upper, lower].map(|v| v / f64::from(count));
    assert!(count > 50 && lower > upper + 0.25, "{count} drops: {upper} above, {lower} below");
}

/// The blower clears the mist from the lower edge up, and all of it in the end.
#[test]
fn mist_is_cleared_from_below() {
    let mut host = Host::new(PLAIN, SIZE, 0.0);
    let (mut last, mut full) = (f64::INFINITY, Vec::new());
    for demist in [0.0, 0.2, 0.4, 0.6, 0.8, 1.0] {
        host.paint();
        let painted = host.pixels();
        let pane = Pane::WholeView(0.4);
        host.view.set_windscreen(Some(&Windscreen { pane, fogging: 0.9, demist, ..upright() })).unwrap();
        host.at(1.0, Stages::LENS, FrameFlags(0)).unwrap();
        let drawn = host.pixels();
        // Change of each row by the mist.
        let change = |i: usize| f64::from((painted[i][0] - drawn[i][0]).abs());
        let width = SIZE.0 as usize;
        let changes: Vec<f64> = (0..SIZE.1 as usize).map(|y| (y * width..(y + 1) * width).map(change).sum()).collect();
        if demist == 0.0 {
            assert!(changes.iter().all(|c| *c > 0.1 * width as f64), "all of the glass is misted at first");
            full.clone_from(&changes);
        }
        let misted: Vec<bool> = changes.iter().zip(&full).map(|(now, full)| *now > 0.5 * full).collect();
        let share = misted.iter().filter(|m| **m).count() as f64 / misted.len() as f64;
        assert!(share < last - 0.05, "{demist}: {share} after {last}");
        last = share;
        // Rows run from the top: misted ones above, clear ones below.
        assert!(misted.is_sorted_by(|a, b| a >= b), "{demist}: cleared from the lower edge upwards");
        assert!(demist < 1.0 || drawn == painted, "none in the end");
    }
    assert!(last == 0.0);
}

/// Ridges of the film lie in arcs around the pivot of the arm that wiped there, not around the other arm's.
#[test]
fn film_lies_in_arcs_about_each_pivot() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, SIZE, 0.3);
    let arm = |x: f64, position| WiperArm {
        pivot_m: [x, 0.02],
        length_m: 0.15,
        inner_radius_m: 0.02,
        parked_deg: 20.0,
        far_deg: 160.0,
        position,
        ..WiperArm::default()
    };
    let pivots = [0.05, 0.35];
    let screen = |position| Windscreen { arms: pivots.map(|x| Some(arm(x, position))), ..upright() };
    for i in 0..=4 {
        host.view.set_windscreen(Some(&screen(f64::from(i) / 4.0))).unwrap();
        host.at(20.0 + f64::from(i) / 60.0, Stages::PREPARE, FrameFlags(0)).unwrap();
    }
    // The picture is brighter to the right, so that a change of brightness is the sideways refraction by the film.
    let ramp = |i: u32| f64::from(i % SIZE.0) / f64::from(SIZE.0);
    let texels = (0..SIZE.0 * SIZE.1).flat_map(|i| [half::f16::from_f64(ramp(i)); 4]);
    let bytes: Vec<u8> = texels.flat_map(|v| v.to_bits().to_le_bytes()).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * SIZE.0), rows_per_image: None };
    host.device.queue.write_texture(host.color.as_image_copy(), &bytes, layout, host.color.size());
    let at = 20.0 + 4.0 / 60.0;
    host.at(at, Stages::LENS, FrameFlags(0)).unwrap();
    let pixels = host.pixels();
    // Share of the refraction's mean square that is left in the means over arcs: near 1 if the refraction is the same
    // along each arc.
    let along_arcs = |centre: f64, own: f64| {
        let mut bins = std::collections::BTreeMap::<i32, (f64, f64, f64)>::new();
        for (a, r) in (0..90).flat_map(|a| (0..110).map(move |r| (a, r))) {
            let (angle, r) = (f64::from(45 + a).to_radians(), 0.03 + 0.001 * f64::from(r));
            let d = glam::DVec2::new(r * angle.cos(), r * angle.sin());
            let [px, py] = pixel([own + d.x, 0.02 + d.y]);
            if d.x.abs() < 0.3 * r || !(0.0..f64::from(SIZE.1)).contains(&py) || !(0.0..f64::from(SIZE.0)).contains(&px)
            {
                continue;
            }
            let i = py as u32 * SIZE.0 + px as u32;
            let bend = (f64::from(pixels[i as usize][0]) - ramp(i)) / d.x * r;
            // Beads refract far more.
            if bend.abs() > 0.05 {
                continue;
            }
            let bin = bins.entry(((own + d.x - centre).hypot(d.y) / 5e-4) as i32).or_default();
            *bin = (bin.0 + bend, bin.1 + bend * bend, bin.2 + 1.0);
        }
        let (between, whole) = bins.values().fold((0.0, 0.0), |s, b| (s.0 + b.0 * b.0 / b.2, s.1 + b.1));
        assert!(whole > 1e-4, "no film: {whole}");
        between / whole
    };
    for i in 0..2 {
        let (own, other) = (along_arcs(pivots[i], pivots[i]), along_arcs(pivots[1 - i], pivots[i]));
        println!("{i}: {own} about its own pivot, {other} about the other");
        assert!(own > 2.0 * other && own > 0.4, "arm {i}: {own} about its own pivot, {other} about the other");
    }
}

#[test]
fn what_the_lens_cannot_draw_is_refused_by_name() {
    let mut host = Host::new(PLAIN, SIZE, 10.0);
    host.view.set_windscreen(Some(&upright())).unwrap();
    let several = texture(&host.device, SIZE, PLAIN, 4);
    let frame = Frame::new(1, camera(), &several, None);
    let e = host.view.record(&host.context, &frame, Stages::LENS).unwrap_err();
    assert!(e.status == Status::Unsupported && e.to_string().contains("color.samples"), "{e}");
    host.view.record(&host.context, &frame, Stages::BACKGROUND).unwrap();
    let parallel = Camera { projection: DMat4::from_scale(DVec3::new(0.1, 0.1, -0.01)), ..camera() };
    let mut frame = Frame::new(2, parallel, &host.color, None);
    frame.depth_mapping = DepthMapping { kind: DepthKind::Orthographic, ..Default::default() };
    let e = host.view.record(&host.context, &frame, Stages::LENS).unwrap_err();
    assert!(e.status == Status::Unsupported && e.to_string().contains("parallel"), "{e}");
    for (name, bad) in [
        ("windscreen.exposed", Windscreen { exposed: 1.5, ..upright() }),
        ("windscreen.fogging", Windscreen { fogging: f64::NAN, ..upright() }),
        ("windscreen.demist", Windscreen { demist: -0.1, ..upright() }),
        ("windscreen.airflow_m_s", Windscreen { airflow_m_s: 101.0, ..upright() }),
        ("windscreen.velocity_m_s[2]", Windscreen { velocity_m_s: DVec3::Z * 500.0, ..upright() }),
        ("windscreen.distance_m", Windscreen { pane: Pane::WholeView(0.0), ..upright() }),
    ] {
        let e = host.view.set_windscreen(Some(&bad)).unwrap_err();
        assert!(e.status == Status::InvalidArgument && e.to_string().contains(name), "{e}");
    }
    let frame = Frame::new(3, camera(), &host.color, None);
    host.view.record(&host.context, &frame, Stages::LENS).unwrap();
    host.view.set_windscreen(None).unwrap();
    assert!(host.view.windscreen_report().unwrap().is_none());
}

#[test]
fn one_call_equals_the_stages_one_by_one_and_costs_are_reported() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, SIZE, 30.0);
    host.view.set_windscreen(Some(&Windscreen { pane: Pane::WholeView(0.4), ..upright() })).unwrap();
    let mut record = |id: u64, stages: &[Stages], flags: FrameFlags| {
        host.context.update(12.0).unwrap();
        let frame = Frame { flags, ..Frame::new(id, camera(), &host.color, None) };
        for stage in stages {
            host.view.record(&host.context, &frame, *stage).unwrap();
        }
        (host.pixels(), host.view.report().costs)
    };
    let (whole, _) = record(1, &[Stages::ALL], FrameFlags(0));
    let behind = Stages::BACKGROUND.with(Stages::MEDIUM).with(Stages::PARTICLES);
    let each = [Stages::PREPARE, behind, Stages::LENS, Stages::TONE];
    let (apart, _) = record(2, &each, FrameFlags(0));
    let (_, costs) = record(3, &[Stages::ALL], FrameFlags::MEASURE);
    for (a, b) in whole.iter().zip(&apart) {
        assert!((0..3).all(|c| (a[c] - b[c]).abs() < 2e-3), "{a:?} {b:?}");
    }
    assert!(costs.unwrap().ms(CostItem::Windscreen) > 0.0);
}

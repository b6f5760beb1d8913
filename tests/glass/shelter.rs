//! Glass below shelters: boxes, maps, and their edges across the pane.

use std::sync::Arc;

use glam::{DMat3, DVec2, DVec3};
use welkin::{
    frame::{FrameFlags, Stages},
    glass::{Reach, reference::Cells, step::Tables},
    gpu::{Device, DeviceOptions},
    rain::{OccluderMap, Planes, Shelter, Taken},
};
use welkin_support::depth_texture::depth_texture;

use crate::{
    cells::acting_on,
    host::{Host, upright},
};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
const SMALL: (u32, u32) = (64, 36);
/// Cells of the upright pane.
const SIZE: [u32; 2] = [100, 60];

/// Creates a box that stands still, in the axes of the world. The host's camera is 3 m above the origin.
fn shelter(center_m: DVec3, half_size_m: DVec3) -> Shelter {
    Shelter { center_m, axes: DMat3::IDENTITY, half_size_m, velocity_m_s: DVec3::ZERO, planes: Planes::NONE }
}

#[test]
fn under_a_box_no_drops_land_and_the_own_cab_is_no_box() {
    let run = |shelters: &[Shelter]| {
        let mut host = Host::new(FORMAT, SMALL, 60.0);
        host.context.set_shelters(shelters).unwrap();
        host.view.set_windscreen(Some(&upright())).unwrap();
        host.at(30.0, Stages::PREPARE, FrameFlags(0)).unwrap();
        host.run(30.0, 31.0, 20.0);
        let report = host.view.windscreen_report().unwrap().unwrap();
        (report, host.view.windscreen_cells().unwrap())
    };
    let (open, wet) = run(&[]);
    assert!(open.drops_per_s > 100.0 && wet.is_some());
    // A roof, and a tunnel that is one box.
    let deck = shelter(DVec3::new(0.0, 0.0, 8.0), DVec3::new(30.0, 30.0, 0.5));
    let tunnel = shelter(DVec3::new(0.0, 0.0, 3.0), DVec3::new(5.0, 80.0, 3.0));
    for shelters in [deck, tunnel] {
        let (report, cells) = run(&[shelters]);
        assert!(report.drops_per_s == 0.0 && report.water_m3 == 0.0 && cells.is_none(), "{report:?}");
    }
    // The glass lies on the box's face, or within it; a box behind keeps nothing off.
    let face = shelter(DVec3::new(0.0, -0.7, 2.5), DVec3::new(1.0, 1.0, 1.5));
    let car = shelter(DVec3::new(0.0, 0.0, 2.5), DVec3::new(1.0, 2.2, 1.5));
    let behind = shelter(DVec3::new(0.0, -40.0, 8.0), DVec3::new(30.0, 30.0, 0.5));
    for shelters in [face, car, behind] {
        let (report, cells) = run(&[shelters]);
        assert!(report == open && cells == wet, "{report:?}");
    }
    // Driven out from under a roof, the glass gets wet; back under it, no more drops land.
    let mut host = Host::new(FORMAT, SMALL, 60.0);
    host.view.set_windscreen(Some(&upright())).unwrap();
    let mut hits = [0; 3];
    for (i, roof) in [true, false, true].into_iter().enumerate() {
        host.context.set_shelters(roof.then_some(&deck)).unwrap();
        let from_s = 30.0 + i as f64;
        host.at(from_s, Stages::PREPARE, FrameFlags(0)).unwrap();
        host.run(from_s, from_s + 0.95, 20.0);
        hits[i] = host.view.windscreen_cells().unwrap().map_or(0, |c| c.water());
    }
    assert!(hits[0] == 0 && hits[1] > 0 && hits[2] < hits[1] + hits[1] / 10, "{hits:?}");
}

/// Returns a roof over everything to the left of the camera.
fn left_roof() -> Shelter {
    shelter(DVec3::new(-15.0, 0.0, 8.0), DVec3::new(15.0, 30.0, 0.5))
}

/// Returns an occluder map from above with texels of 1.6 cm: roofs 8 m up where `roofed` is true for (east, north).
fn map_of(host: &Host, roofed: impl Fn(DVec2) -> bool) -> (wgpu::Texture, Taken) {
    const SIDE: u32 = 512;
    let taken = Taken::parallel(DVec3::new(0.0, 0.0, 30.0), DVec3::NEG_Z, [4.0; 2], 40.0);
    let from_clip = taken.clip_from_world.inverse();
    let depth = |i: u32| {
        let at = DVec2::new(f64::from(i % SIDE) + 0.5, f64::from(i / SIDE) + 0.5) / f64::from(SIDE);
        let p = from_clip.project_point3(DVec3::new(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y, 1.0));
        let z = if roofed(p.truncate()) { 8.0 } else { 0.0 };
        taken.clip_from_world.project_point3(p.truncate().extend(z)).z as f32
    };
    let depths: Vec<f32> = (0..SIDE * SIDE).map(depth).collect();
    (depth_texture(&host.device, (SIDE, SIDE), &depths), taken)
}

/// Returns the declared glass, the water that has landed in each column half a second later, and the reported drops a
/// second: below a roof, and below an occluder map that has a roof where `mapped` is true for (east, north).
fn columns(
    device: &Arc<Device>,
    roof: Option<Shelter>,
    mapped: Option<fn(DVec2) -> bool>,
) -> (Option<Cells>, Vec<u32>, f64) {
    let mut host = Host::on(device.clone(), FORMAT, SMALL, 60.0, 7);
    host.context.set_shelters(roof.as_slice()).unwrap();
    if let Some(roofed) = mapped {
        let (texture, taken) = map_of(&host, roofed);
        host.context.set_occluder_maps(&[OccluderMap { depth: &texture, taken }]).unwrap();
    }
    host.view.set_windscreen(Some(&upright())).unwrap();
    host.at(30.0, Stages::PREPARE, FrameFlags(0)).unwrap();
    let declared = host.view.windscreen_cells().unwrap();
    host.run(30.0, 30.5, 20.0);
    let mut hits = vec![0; SIZE[0] as usize];
    if let Some(cells) = host.view.windscreen_cells().unwrap() {
        cells.cells.iter().enumerate().for_each(|(i, c)| hits[i % SIZE[0] as usize] += c[3] & 4095);
    }
    (declared, hits, host.view.windscreen_report().unwrap().unwrap().drops_per_s)
}

#[test]
fn a_pane_half_below_an_edge_gets_rain_on_its_open_half_by_boxes_and_by_maps() {
    for backends in [DeviceOptions::default().backends, wgpu::Backends::GL] {
        let device = Device::headless(&DeviceOptions { backends, ..Default::default() }).unwrap();
        let (open, all, drops) = columns(&device, None, None);
        let open = open.unwrap();
        for (roof, mapped) in [(Some(left_roof()), None), (None, Some((|p: DVec2| p.x < 0.0) as fn(DVec2) -> bool))] {
            let by = if roof.is_some() { "a box" } else { "a map" };
            let (declared, hits, reported) = columns(&device, roof, mapped);
            // Nodes lie 6.7 cells apart, texels 4: columns nearer to the edge get a part of the drops.
            for (i, (a, b)) in declared.unwrap().cells.iter().zip(&open.cells).enumerate() {
                let x = i % SIZE[0] as usize;
                assert!(x > 38 || (a[0] == 0 && a[3] & 4095 == 0), "by {by}: {a:?} in column {x}");
                assert!(x < 62 || a == b, "by {by}: {a:?} for {b:?} in column {x}");
            }
            let sum = |columns: &[u32]| columns.iter().sum::<u32>();
            assert!(sum(&hits[..38]) == 0 && sum(&all[..38]) > 100, "by {by}: {hits:?}");
            let kept = f64::from(sum(&hits[62..])) / f64::from(sum(&all[62..]));
            assert!((kept - 1.0).abs() < 0.05, "by {by}: {kept}");
            assert!((reported / drops - 0.5).abs() < 0.05, "by {by}: {reported} of {drops}");
        }
        let (_, hits, reported) = columns(&device, None, Some(|_| true));
        assert!(hits.iter().all(|h| *h == 0) && reported == 0.0, "all of it below a map: {reported}");
    }
}

#[test]
fn the_gpu_has_the_bits_of_the_twin_below_an_edge() {
    let reach = Reach::of(|[x, _]| if x < 0.5 { 0.0 } else { 1.0 });
    for backends in [DeviceOptions::default().backends, wgpu::Backends::GL] {
        let device = Device::headless(&DeviceOptions { backends, ..Default::default() }).unwrap();
        let mut host = Host::on(device, FORMAT, SMALL, 60.0, 7);
        host.context.set_shelters(&[left_roof()]).unwrap();
        host.view.set_windscreen(Some(&upright())).unwrap();
        host.at(50.0, Stages::PREPARE, FrameFlags(0)).unwrap();
        let mut tables = Tables::default();
        let acts = acting_on(&host, 60.0);
        let mut twin = Cells::declared(&tables.at((&acts, &reach), 7, 3000, SIZE, &[None; 2]));
        for step in 3001..3060 {
            host.at(f64::from(step) / 60.0, Stages::PREPARE, FrameFlags(0)).unwrap();
            twin = twin.stepped(&tables.at((&acts, &reach), 7, step.into(), SIZE, &[None; 2]));
        }
        assert!(host.view.windscreen_cells().unwrap().unwrap() == twin && twin.water() > 0);
    }
}

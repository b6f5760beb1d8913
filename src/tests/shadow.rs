//! Shadows of the drawn terrain on the software driver, against rays through every triangle of the ground.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{
    land::{clear_images, host_with, looking, looking_through},
    opaque::host::{Host, Mapped, ndc, pixels},
    textures::texture,
};
use crate::{
    chance::RandomStream,
    context::{Context, ContextDesc},
    frame::{DepthAccess, Frame, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    land::{
        TerrainDrawing,
        reference::{DISC, disc_share, ray_to_ground},
    },
    terrain::{Rows, TerrainCells, TerrainDesc, TileKey},
    world::GivenDirection,
};

/// Height of hills whose waves are 17 to 210 m long, m.
fn hills(x: f64, y: f64) -> f64 {
    let wave = |length: f64, turn: f64| {
        let (sine, cosine) = libm::sincos(turn);
        libm::sin((cosine * x + sine * y) * std::f64::consts::TAU / length)
    };
    14.0 * wave(210.0, 0.3) + 6.0 * wave(97.0, 1.4) + 2.0 * wave(41.0, 2.5) + 0.6 * wave(17.0, 0.9)
}

fn origin(host: &Host) -> DVec3 {
    host.context.world.set.tiles.as_ref().expect("tiles are set").desc.origin
}

fn set_sun(host: &mut Host, azimuth_deg: f64, elevation_deg: f64) -> DVec3 {
    host.context.set_sun(Some(GivenDirection { azimuth_deg, elevation_deg })).unwrap();
    let (azimuth, elevation) = (azimuth_deg.to_radians(), elevation_deg.to_radians());
    DVec3::new(azimuth.sin() * elevation.cos(), azimuth.cos() * elevation.cos(), elevation.sin())
}

fn draw(host: &mut Host, case: &Mapped) -> Vec<[f32; 4]> {
    clear_images(&host.device, [&host.color, &host.depth]);
    host.record(case, Stages::SURFACE, |_| ());
    host.colors()
}

/// Share of the sun's light at each pixel that the drawn shadows leave, from pictures with shadows, without, and
/// without the sun; `None` where the sun adds less than a share of the light.
fn drawn_shares(host: &mut Host, case: &Mapped, least: f64) -> Vec<Option<f64>> {
    // In so small a picture far ground is coarse, and so are its shadows near the eye.
    let drawing = TerrainDrawing { error_px: 0.25, ..TerrainDrawing::default() };
    host.context.set_terrain_drawing(Some(TerrainDrawing { shadows_to_m: 0.0, ..drawing })).unwrap();
    let lit = draw(host, case);
    host.view.effects.land.is_dark = true;
    let dark = draw(host, case);
    host.view.effects.land.is_dark = false;
    host.context.set_terrain_drawing(Some(drawing)).unwrap();
    let shaded = draw(host, case);
    let share = |i: usize| {
        let [a, b, c] = [&shaded, &lit, &dark].map(|picture| f64::from(picture[i][1]));
        (b - c > least * b && b > 0.0).then(|| (a - c) / (b - c))
    };
    pixels().map(share).collect()
}

/// Counts of pixels: wholly lit and wholly shaded ones, and those of either kind that are drawn otherwise.
#[derive(Debug, Default)]
struct Counts {
    lit: usize,
    shaded: usize,
    wrong: [usize; 2],
    off: [f64; 2],
}

/// Compares a picture's shadows with rays to the whole disc, at places farther than 1.5 texels from any edge.
fn compare(host: &mut Host, case: &Mapped, sun: DVec3, counts: &mut Counts) {
    let shares = drawn_shares(host, case, 0.05);
    let (rays, origin) = (case.rays(), origin(host));
    let terrain = host.context.world.set.tiles.as_ref().expect("tiles are set");
    let eye = case.camera.position - origin;
    let top_m = f64::from(terrain.all().flat_map(|(_, tile)| tile.heights_m.iter().copied()).fold(0.0, f32::max));
    for i in pixels().step_by(3) {
        let Some(drawn) = shares[i] else { continue };
        let direction = rays.view_ray(ndc(i)).direction;
        let Some(range) = ray_to_ground(terrain, eye, direction, 2000.0) else { continue };
        let place = eye + range * direction;
        let Some([_, texel]) = host.view.effects.land.shadow_texels_m(place - eye) else { continue };
        let level = |off: DVec2| {
            let at = DVec2::new(place.x, place.y) + off;
            let height = terrain.height_at(at / terrain.desc.cell_m)?;
            Some(disc_share(terrain, at.extend(height + 0.02), sun, top_m))
        };
        // Places on the ground 1.5 texels beside this one, and before and behind it, as seen from the sun.
        let along = DVec2::new(sun.x, sun.y).normalize();
        let [beside, along] = [along.perp() * 1.5 * texel, along * 1.5 * texel / sun.z.max(0.05)];
        let Some(here) = level(DVec2::ZERO) else { continue };
        let is_same = |off: &DVec2| level(*off) == Some(here);
        if (here != 0.0 && here != 1.0) || ![beside, -beside, along, -along].iter().all(is_same) {
            continue;
        }
        if here == 1.0 {
            counts.lit += 1
        } else {
            counts.shaded += 1
        }
        counts.wrong[here as usize] += usize::from((drawn - here).abs() > 0.1);
        counts.off[here as usize] += (drawn - here).abs();
    }
}

#[test]
fn hills_are_lit_and_shaded_as_rays_to_the_sun_say() {
    let mut host = host_with(1.0, hills);
    let mut chance = RandomStream::new(5, 44);
    let mut all = Counts::default();
    for elevation in [3.0, 8.0, 20.0, 45.0, 80.0] {
        let mut counts = Counts::default();
        for over in [1.7, 12.0, 90.0] {
            let sun = set_sun(&mut host, 360.0 * chance.unit(), elevation);
            let at = [chance.unit(), chance.unit()].map(|v| 120.0 + 270.0 * v);
            let terrain = host.context.world.set.tiles.as_ref().expect("tiles are set");
            let ground = terrain.height_at(at.into()).unwrap();
            let eye = origin(&host) + DVec3::new(at[0], at[1], ground + over);
            let towards = origin(&host) + DVec3::new(256.0, 256.0, -0.3 * over) - eye;
            compare(&mut host, &looking(eye, towards), sun, &mut counts);
        }
        println!("sun at {elevation} degrees: {counts:?}");
        all.lit += counts.lit;
        all.shaded += counts.shaded;
        all.wrong = [0, 1].map(|i| all.wrong[i] + counts.wrong[i]);
    }
    assert!(all.lit > 1000 && all.shaded > 500, "{all:?}");
    assert!(all.wrong[1] * 200 < all.lit && all.wrong[0] * 25 < all.shaded, "{all:?}");
}

/// Height of the wall of [`walled`], m, and place of its eastern edge, cells.
const WALL: f64 = 20.0;
const EDGE: f64 = 64.0;

fn walled(x: f64, _: f64) -> f64 {
    if (56.0..=EDGE).contains(&x) { WALL } else { 0.0 }
}

/// Direction down, with north at the top of the picture.
const DOWN: DVec3 = DVec3::new(0.0, 1e-6, -1.0);

/// Places at which the share of a profile passes a value, linearly interpolated.
fn crossing(profile: &[(f64, f64)], share: f64) -> f64 {
    let pair = profile.windows(2).find(|pair| (pair[0].1 < share) != (pair[1].1 < share));
    let [a, b] = [pair.expect("the profile passes")[0], pair.expect("the profile passes")[1]];
    a.0 + (b.0 - a.0) * (share - a.1) / (b.1 - a.1)
}

#[test]
fn the_edge_of_a_shadow_is_where_the_sun_puts_it_and_as_wide_as_its_disc() {
    let mut host = host_with(1.0, walled);
    let mut wide = 0;
    for (elevation, over) in [(3.0, 40.0), (5.0, 12.0), (10.0, 8.0), (20.0, 40.0), (45.0, 15.0), (80.0, 5.0)] {
        set_sun(&mut host, 270.0, elevation);
        let angle = elevation.to_radians();
        let edge = EDGE + WALL / angle.tan();
        let eye = origin(&host) + DVec3::new(edge, 250.0, over);
        // Width of the penumbra on the ground from none to all of the disc.
        let whole = 2.0 * DISC * WALL / angle.sin().powi(2);
        draw(&mut host, &looking_through(eye, DOWN, 0.5));
        let [fine, coarse] = host.view.effects.land.shadow_texels_m(DVec3::new(0.0, 0.0, -over)).unwrap();
        let radius = DISC * WALL / angle.sin();
        let texel = if radius > 6.0 * fine { coarse } else { fine };
        let width = (2.0 * whole).max(24.0 * texel / angle.sin()).min(60.0);
        let case = looking_through(eye, DOWN, 2.0 * (0.5 * width * 36.0 / 64.0 / over).atan());
        let shares = drawn_shares(&mut host, &case, 0.005);
        let rays = case.rays();
        let profile: Vec<(f64, f64)> = (0..64)
            .map(|x| {
                let direction = rays.view_ray(ndc(x)).direction;
                let at = edge + over * direction.x / -direction.z;
                (at, (0..36).map(|y| shares[y * 64 + x].unwrap()).sum::<f64>() / 36.0)
            })
            .collect();
        let off = (crossing(&profile, 0.5) - edge) * angle.sin() / texel;
        let steep = crossing(&profile, 0.75) - crossing(&profile, 0.25);
        // A quarter and three quarters of the disc are in view 0.404 of its radius to either side of its middle.
        let ratio = steep / (0.404 * whole);
        println!(
            "sun at {elevation} degrees from {over} m: off by {off:.2} texels of {texel:.3} m, penumbra {ratio:.2} of {whole:.3} m"
        );
        assert!(off.abs() < 1.5, "{elevation}: {off} texels");
        if 2.0 * radius > 4.0 * texel {
            wide += 1;
            assert!((ratio - 1.0).abs() < 0.2, "{elevation}: {ratio}");
        }
    }
    assert!(wide >= 2, "{wide}");
}

#[test]
fn one_map_serves_many_frames() {
    let mut host = host_with(1.0, hills);
    set_sun(&mut host, 130.0, 30.0);
    let start = origin(&host) + DVec3::new(200.0, 180.0, 25.0);
    draw(&mut host, &looking(start, DVec3::new(0.3, 1.0, -0.2)));
    let drawn = |host: &Host| host.view.effects.land.maps_drawn();
    assert_eq!(drawn(&host), 4);
    // A camera that turns, and one that stands.
    for turn in 0..6 {
        let forward = DVec2::from_angle(f64::from(turn)).extend(-0.2);
        draw(&mut host, &looking(start, forward));
    }
    assert_eq!(drawn(&host), 4);
    // A second of a drive at 10 m/s, while the sun goes at 60 times its pace.
    let mut most = 0;
    for step in 1..=60 {
        let before = drawn(&host);
        set_sun(&mut host, 130.0, 30.0 + 0.25 * f64::from(step) / 60.0);
        draw(&mut host, &looking(start + DVec3::X * f64::from(step) / 6.0, DVec3::new(0.3, 1.0, -0.2)));
        most = most.max(drawn(&host) - before);
    }
    println!("{} maps in 60 frames, at most {most} in one", drawn(&host) - 4);
    assert!(most == 1 && drawn(&host) - 4 < 40);
}

#[test]
fn the_shadow_of_a_pit_comes_with_it() {
    let mut host = host_with(1.0, |_, _| 0.0);
    set_sun(&mut host, 90.0, 25.0);
    let eye = origin(&host) + DVec3::new(201.0, 180.0, 14.0);
    let case = looking(eye, DVec3::new(0.0, 0.25, -1.0));
    let shaded = |host: &mut Host| {
        let shares = drawn_shares(host, &case, 0.05);
        shares.iter().flatten().filter(|share| **share < 0.1).count()
    };
    assert_eq!(shaded(&mut host), 0);
    let pit = vec![-4.0; 6 * 6];
    let cells = TerrainCells {
        key: TileKey::new(1, 1),
        first: [71, 52],
        size: [6, 6],
        heights_m: Rows::of(&pit),
        ..TerrainCells::default()
    };
    host.context.update_terrain(&cells).unwrap();
    let dark = shaded(&mut host);
    println!("{dark} pixels are in shadow");
    assert!(dark > 40, "{dark}");
}

/// Picture of hills under a low sun by a driver of one kind, without shadows and with.
fn pictures_by(backends: wgpu::Backends) -> [Vec<[f32; 4]>; 2] {
    let device = Device::headless(&DeviceOptions { backends, ..DeviceOptions::default() }).unwrap();
    let shared = Arc::new(Shared::new(&device).unwrap());
    let mut context = Context::new(device.clone(), shared, ContextDesc::default()).unwrap();
    let desc = TerrainDesc { cell_m: 1.0, tile_cells: 128, ..TerrainDesc::default() };
    context.set_terrain(Some(desc)).unwrap();
    let heights: Vec<f32> = (0..128 * 128).map(|i| hills(f64::from(i % 128), f64::from(i / 128)) as f32).collect();
    context.set_terrain_tile(&TerrainCells { heights_m: Rows::of(&heights), ..TerrainCells::default() }).unwrap();
    context.set_sun(Some(GivenDirection { azimuth_deg: 60.0, elevation_deg: 8.0 })).unwrap();
    context.update(0.0).unwrap();
    let mut view = View::new(&context).unwrap();
    let [color, depth] = [wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Depth32Float]
        .map(|format| texture(&device, (64, 36), format, 1));
    let eye = DVec3::new(64.0, 10.0, hills(64.0, 10.0) + 20.0);
    let case = looking(eye, DVec3::new(0.1, 1.0, -0.4));
    [0.0, 1e4].map(|shadows_to_m| {
        let drawing = TerrainDrawing { shadows_to_m, ..TerrainDrawing::default() };
        context.set_terrain_drawing(Some(drawing)).unwrap();
        clear_images(&device, [&color, &depth]);
        let mut frame = Frame::new(1 + shadows_to_m as u64, case.camera, &color, Some(&depth));
        (frame.depth_mapping, frame.depth_access) = (case.mapping, DepthAccess::ReadWrite);
        view.record(&context, &frame, Stages::SURFACE).unwrap();
        device.check().unwrap();
        readback::rgba(&device, &color).unwrap()
    })
}

#[test]
fn opengl_draws_the_same_shadows() {
    let [lit, shaded] = pictures_by(wgpu::Backends::VULKAN);
    let [lit_gl, shaded_gl] = pictures_by(wgpu::Backends::GL);
    let darker = (0..lit.len()).filter(|i| shaded[*i][1] < 0.98 * lit[*i][1]).count();
    let differ = |a: &[[f32; 4]], b: &[[f32; 4]]| {
        a.iter().zip(b).filter(|(a, b)| (a[1] - b[1]).abs() > 0.01 * a[1].max(1.0)).count()
    };
    let differences = [differ(&lit, &lit_gl), differ(&shaded, &shaded_gl)];
    println!("{darker} pixels are in shadow, {differences:?} differ");
    assert!(darker > 40 && differences.iter().all(|count| *count < 12), "{darker}, {differences:?}");
}

//! Materials of the ground: wet natural ground hardly changes, wet paved ground darkens and mirrors.

use glam::{DMat3, DVec2, DVec3};
use welkin::{
    context::GivenDirection,
    frame::{Frame, FrameFlags, Stages},
    ground::{
        GroundGrid, SurfaceClass,
        reference::{WATER_OUTSIDE, wet_share},
    },
    weather::{CloudKind, CloudLayer, Surface, SurfaceState, Weather, Wind},
};

use crate::{
    hills::{self, SurfaceImages, camera, hits, save, shoot},
    host::{Host, SIZE, ground, look},
};

const EYE: DVec3 = DVec3::new(0.0, -100.0, 95.0);
const GRASS: [f64; 3] = [0.09, 0.16, 0.05];
const SOIL: [f64; 3] = [0.22, 0.16, 0.11];
const ASPHALT: [f64; 3] = [0.11, 0.11, 0.11];

/// Rain of 20 mm/h on ground that is wet all over.
fn rain(host: &mut Host) {
    let mut weather = Weather::preset("heavy_rain").unwrap();
    weather.precipitation.rate_mm_h = 20.0;
    weather.wind = Wind::of(3.0, 240.0);
    weather.surface.state = Some(SurfaceState::StandingWater);
    host.context.set_weather(&weather, host.context.time_s(), 0.0).unwrap();
}

/// A low sun on ground that is wet all over.
fn sun_after_rain(host: &mut Host) {
    let surface = Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() };
    let weather = Weather { surface, wind: Wind::of(3.0, 240.0), ..Weather::default() };
    host.context.set_weather(&weather, host.context.time_s(), 0.0).unwrap();
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 250.0, elevation_deg: 14.0 })).unwrap();
}

/// An even grey sky over ground in this state.
fn overcast(host: &mut Host, state: SurfaceState) {
    let surface = Surface { state: Some(state), ..Surface::default() };
    let clouds = vec![CloudLayer::of(CloudKind::Stratus, 1.0, 600.0)];
    let weather = Weather { surface, clouds, wind: Wind::of(0.0, 0.0), ..Weather::default() };
    host.context.set_weather(&weather, host.context.time_s(), 0.0).unwrap();
}

/// Returns a host that has set no material of its ground.
fn silent() -> Host {
    let mut host = Host::new();
    host.context.set_default_surface_class(SurfaceClass::Unspecified);
    host
}

type Weathered = (&'static str, fn(&mut Host));

const WEATHERS: [Weathered; 2] = [("rain", rain), ("sun", sun_after_rain)];

fn on_road(at: DVec2) -> bool {
    (at.y - 300.0).abs() < 40.0
}

/// The albedo of soil with smooth bright and dark spots, and of an asphalt road across it.
fn site(at: DVec2) -> [f64; 3] {
    let spots = 1.0 + 0.2 * (at.x * 0.31).sin() * (at.y * 0.23).cos();
    if on_road(at) { ASPHALT } else { SOIL.map(|a| a * spots) }
}

/// Largest difference of any channel.
fn apart(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let of = |(a, b): (&[f64; 3], &[f64; 3])| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0, f64::max);
    a.iter().zip(b).map(of).fold(0.0, f64::max)
}

/// The number of a class at each pixel.
fn classes(host: &Host, hits: &[Option<DVec3>], class: impl Fn(DVec2) -> SurfaceClass) -> wgpu::Texture {
    let bytes: Vec<u8> = hits.iter().map(|h| h.map_or(0, |p| class(p.truncate()) as u8)).collect();
    host.image(wgpu::TextureFormat::R8Unorm, &bytes)
}

/// Normals that the host interpolates, as a float image holds them, in axes that are `turned` against the world's.
fn normals(host: &Host, hits: &[Option<DVec3>], turned: glam::DMat3) -> wgpu::Texture {
    let of = |h: &Option<DVec3>| {
        let n = turned * h.map_or(DVec3::ZERO, |p| hills::normal(p.truncate()));
        [n.x, n.y, n.z, 0.0].map(|v| half::f16::from_f64(v).to_bits())
    };
    let texels: Vec<[u16; 4]> = hits.iter().map(of).collect();
    host.image(wgpu::TextureFormat::Rgba16Float, bytemuck::cast_slice(&texels))
}

#[test]
fn the_near_plane_does_not_change_wet_ground() {
    let mut host = silent();
    let mut worst = 0f64;
    for (weather, set) in WEATHERS {
        set(&mut host);
        for elevation in [-8.0, -35.0] {
            let [near, tiny] = [9.4, 0.19].map(|m| camera(EYE, elevation, m));
            let hits = hits(&near);
            let marked = classes(&host, &hits, |at| if on_road(at) { SurfaceClass::Paved } else { SurfaceClass::Soil });
            let grass: fn(DVec2) -> [f64; 3] = |_| GRASS;
            for (name, albedo, classes) in
                [("grass", grass, None), ("silent site", site, None), ("marked site", site, Some(&marked))]
            {
                let given = SurfaceImages { classes, ..SurfaceImages::default() };
                let a = shoot(&mut host, near, &hits, albedo, given);
                let b = shoot(&mut host, tiny, &hits, albedo, given);
                let name = format!("{weather}_{name}_{elevation}");
                save(&format!("{name}_near_9.4"), &a);
                save(&format!("{name}_near_0.19"), &b);
                worst = worst.max(apart(&a, &b));
            }
        }
    }
    assert!(worst < 3.0, "{worst} of 255");
}

/// Returns the largest step, from a pixel to the next one in its row, of the difference of two pictures, silhouettes
/// left out.
fn largest_step(a: &[[f64; 3]], b: &[[f64; 3]], eye: DVec3, hits: &[Option<DVec3>]) -> f64 {
    let off = |i: usize| (0..3).map(|c| a[i][c] - b[i][c]).sum::<f64>() / 3.0;
    let range = |i: usize| hits[i].map_or(f64::NAN, |p| (p - eye).length());
    let row = SIZE.0 as usize;
    let beside = (1..a.len()).filter(|i| i % row > 0 && (range(*i) / range(i - 1) - 1.0).abs() < 0.05);
    beside.map(|i| (off(i) - off(i - 1)).abs()).fold(0.0, f64::max)
}

#[test]
fn smooth_shaded_hills_do_not_show_their_triangles() {
    let mut host = silent();
    let camera = camera(EYE, -8.0, 9.4);
    let hits = hits(&camera);
    let smooth = normals(&host, &hits, DMat3::IDENTITY);
    let given = SurfaceImages { normals: Some(&smooth), ..SurfaceImages::default() };
    for (weather, set) in WEATHERS {
        set(&mut host);
        for (name, albedo) in [("grass", GRASS), ("soil", SOIL)] {
            let by_depth = shoot(&mut host, camera, &hits, |_| albedo, SurfaceImages::default());
            let by_normals = shoot(&mut host, camera, &hits, |_| albedo, given);
            save(&format!("hills_{weather}_{name}"), &by_depth);
            save(&format!("hills_{weather}_{name}_normals"), &by_normals);
            let step = largest_step(&by_depth, &by_normals, EYE, &hits);
            assert!(step < 1.0, "{weather}, {name}: a step of {step} of 255");
        }
        // All ground is paved. The terrain's heights give normals that the depth cannot.
        host.context.set_ground_grid(Some(hills::grid(|_| SurfaceClass::Paved))).unwrap();
        let by_terrain = shoot(&mut host, camera, &hits, |_| ASPHALT, SurfaceImages::default());
        let by_normals = shoot(&mut host, camera, &hits, |_| ASPHALT, given);
        save(&format!("hills_{weather}_paved"), &by_terrain);
        save(&format!("hills_{weather}_paved_normals"), &by_normals);
        let step = largest_step(&by_terrain, &by_normals, EYE, &hits);
        assert!(step < 4.0, "{weather}, paved: a step of {step} of 255");
        host.context.set_ground_grid(None).unwrap();
    }
}

/// Mean value that a display shows in the middle of the picture, over level ground of this albedo, 0 to 255 a channel.
fn shown(host: &mut Host, albedo: [f64; 3], elevation_deg: f64, given: SurfaceImages<'_>) -> [f64; 3] {
    let eye = DVec3::new(0.0, 300.0, 1.7);
    let camera = camera(eye, elevation_deg, 0.1);
    let pixels = shoot(host, camera, &hits(&camera), |_| albedo, given);
    let rows = pixels.chunks(SIZE.0 as usize).skip(SIZE.1 as usize / 2 - 2).take(5);
    let middle: Vec<_> = rows.flat_map(|row| &row[60..100]).collect();
    [0, 1, 2].map(|c| middle.iter().map(|p| p[c]).sum::<f64>() / middle.len() as f64)
}

#[test]
fn wet_grass_hardly_changes_and_wet_asphalt_darkens_and_mirrors_flat_looks() {
    let mut host = silent();
    let mut changes = |albedo: [f64; 3], class: SurfaceClass, elevation: f64| {
        host.context.set_default_surface_class(class);
        overcast(&mut host, SurfaceState::Dry);
        let before = shown(&mut host, albedo, elevation, SurfaceImages::default());
        overcast(&mut host, SurfaceState::Wet);
        let after = shown(&mut host, albedo, elevation, SurfaceImages::default());
        (after[1] - before[1]) / before[1]
    };
    for elevation in [-6.0, -60.0] {
        let grass = changes(GRASS, SurfaceClass::Unspecified, elevation);
        assert!((-0.06..0.0).contains(&grass), "grass at {elevation}: {grass}");
        let soil = changes(SOIL, SurfaceClass::Unspecified, elevation);
        assert!((-0.3..-0.1).contains(&soil), "soil at {elevation}: {soil}");
        let silent = changes(ASPHALT, SurfaceClass::Unspecified, elevation);
        assert!((-0.35..-0.1).contains(&silent), "a road that nobody marked at {elevation}: {silent}");
    }
    let (flat, steep) = (changes(ASPHALT, SurfaceClass::Paved, -6.0), changes(ASPHALT, SurfaceClass::Paved, -60.0));
    assert!(flat > 0.1 && (-0.35..-0.1).contains(&steep), "{flat} {steep}");
}

#[test]
fn natural_ground_darkens_by_the_law_of_wet_albedo() {
    let mut host = silent();
    let eye = DVec3::new(0.0, 0.0, 2.0);
    host.ground_is(SurfaceState::Wet);
    let down = look(eye, 0.0, -90.0, 0.5);
    let light = host.context.scene_at(eye, 0.0).unwrap().ground;
    let sun = light.sun_lux[1] * 40f64.to_radians().sin();
    let total = sun + light.sky_lux[1];
    let entering = {
        use welkin::ground::reference::fresnel_water;
        1.0 - (sun * fresnel_water(50f64.to_radians().cos()) + light.sky_lux[1] * WATER_OUTSIDE) / total
    };
    for (class, share) in [(SurfaceClass::Soil, 1.0), (SurfaceClass::Rock, 1.0), (SurfaceClass::Vegetation, 0.15)] {
        host.context.set_default_surface_class(class);
        let mut mean = |albedo: f64| {
            let lux = |c: usize| light.sun_lux[c] * 40f64.to_radians().sin() + light.sky_lux[c];
            let pixels = host.shoot(down, Stages::SURFACE, |d| {
                ground(eye, d, [0, 1, 2].map(|c| albedo * lux(c) / std::f64::consts::PI))
            });
            pixels.iter().map(|p| f64::from(p[1])).sum::<f64>() / pixels.len() as f64 * std::f64::consts::PI / total
        };
        let mirrored = mean(0.0);
        assert!(mirrored < 0.01, "{class:?}: {mirrored}");
        for albedo in [0.1, 0.2, 0.4] {
            let wanted = albedo * (1.0 + share * (wet_share(albedo, entering) - 1.0));
            let got = mean(albedo) - mirrored;
            assert!((got / wanted - 1.0).abs() < 0.02, "{class:?}, albedo {albedo}: {got}, want {wanted}");
        }
    }
}

#[test]
fn hosts_water_stays_bit_for_bit_and_roofs_have_no_puddles() {
    let mut host = silent();
    overcast(&mut host, SurfaceState::StandingWater);
    let eye = DVec3::new(0.0, 0.0, 15.0);
    let down = look(eye, 0.0, -90.0, 0.9);
    let mut spread = |class: SurfaceClass| {
        host.context.set_default_surface_class(class);
        let pixels = host.shoot(down, Stages::SURFACE, |d| ground(eye, d, [1500.0; 3]));
        let ends = pixels.iter().fold((f32::MAX, 0f32), |(l, h), p| (l.min(p[1]), h.max(p[1])));
        (ends.0, ends.1 / ends.0 - 1.0)
    };
    assert_eq!(spread(SurfaceClass::Water), (1500.0, 0.0));
    let [paved, roof, soil] = [SurfaceClass::Paved, SurfaceClass::Building, SurfaceClass::Soil].map(|c| spread(c).1);
    assert!(paved > 0.05 && roof < 0.03 && soil < 0.01, "{paved} {roof} {soil}");
}

/// Draws level ground of one luminance, with the host's classes.
fn level(host: &mut Host, classes: Option<&wgpu::Texture>) -> Vec<[f32; 4]> {
    let eye = DVec3::new(0.0, 0.0, 12.0);
    let camera = look(eye, 0.0, -90.0, 0.9);
    host.paint(&camera, |d| ground(eye, d, [1200.0; 3]));
    let frame =
        Frame { surface_classes: classes, ..Frame::new(host.next_frame(), camera, &host.color, Some(&host.depth)) };
    host.view.record(&host.context, &frame, Stages::SURFACE).unwrap();
    host.pixels()
}

#[test]
fn an_image_of_classes_overrides_the_terrain_and_the_terrain_the_default() {
    let mut host = silent();
    host.ground_is(SurfaceState::Wet);
    let grid = |class: fn(u32) -> SurfaceClass| GroundGrid {
        origin: DVec3::new(-40.0, -40.0, 0.0),
        cell_m: 1.0,
        nodes: [81; 2],
        heights_m: vec![0.0; 81 * 81],
        classes: (0..81 * 81).map(|i| class(i % 81)).collect(),
    };
    let west = |column: u32| if column < 40 { SurfaceClass::Soil } else { SurfaceClass::Unspecified };
    let mut of = |class: SurfaceClass| {
        host.context.set_default_surface_class(class);
        host.context.set_ground_grid(Some(grid(|_| SurfaceClass::Unspecified))).unwrap();
        level(&mut host, None)
    };
    let [soil, rock, plants] = [SurfaceClass::Soil, SurfaceClass::Rock, SurfaceClass::Vegetation].map(&mut of);
    host.context.set_default_surface_class(SurfaceClass::Rock);
    host.context.set_ground_grid(Some(grid(west))).unwrap();
    let rows = SIZE.0 as usize * 20;
    let bytes: Vec<u8> =
        (0..(SIZE.0 * SIZE.1) as usize).map(|i| if i < rows { SurfaceClass::Vegetation as u8 } else { 0 }).collect();
    let image = host.image(wgpu::TextureFormat::R8Unorm, &bytes);
    let mixed = level(&mut host, Some(&image));
    for (i, pixel) in mixed.iter().enumerate() {
        let x = i as u32 % SIZE.0;
        // Over one cell on either side of the border one class blends into the other.
        let between = (x as f64 + 0.5 - 80.0).abs() < 10.0;
        let wanted = if i < rows {
            &plants
        } else if x < 80 {
            &soil
        } else {
            &rock
        };
        assert!(between && i >= rows || *pixel == wanted[i], "pixel {i}: {pixel:?}, wanted {:?}", wanted[i]);
    }
    assert!(soil != rock && rock != plants && soil != plants);
    let at = |host: &Host, x: f64| host.context.ground_at(DVec3::new(x, 0.0, 0.0)).unwrap().surface_class;
    let there = [-5.0, 5.0, 500.0].map(|x| at(&host, x));
    assert_eq!(there, [SurfaceClass::Soil, SurfaceClass::Rock, SurfaceClass::Rock]);
    // Setting the same heights again keeps the water, even with other classes.
    let revision = host.context.ground_revision();
    host.context.set_ground_grid(Some(grid(|_| SurfaceClass::Paved))).unwrap();
    assert_eq!((at(&host, -5.0), host.context.ground_revision()), (SurfaceClass::Paved, revision));
}

#[test]
fn normals_say_the_same_in_each_encoding_and_where_they_are_none_depth_is_asked() {
    let mut host = silent();
    rain(&mut host);
    host.context.set_default_surface_class(SurfaceClass::Paved);
    let camera = camera(EYE, -35.0, 9.4);
    let hits = hits(&camera);
    let world = normals(&host, &hits, DMat3::IDENTITY);
    let eye = normals(&host, &hits, camera.rotation());
    let coded = |n: DVec3| [n.x, n.y, n.z].map(|v| (127.5 * (v + 1.0)).round() as u8);
    let bytes: Vec<u8> = hits
        .iter()
        .flat_map(|h| {
            let [r, g, b] = h.map_or([0; 3], |p| coded(hills::normal(p.truncate())));
            [r, g, b, 255]
        })
        .collect();
    let bytes = host.image(wgpu::TextureFormat::Rgba8Unorm, &bytes);
    let mut picture = |normals: Option<&wgpu::Texture>, flags: FrameFlags| {
        shoot(
            &mut host,
            camera,
            &hits,
            |_| ASPHALT,
            SurfaceImages { normals, flags: flags.0, ..SurfaceImages::default() },
        )
    };
    let wanted = picture(Some(&world), FrameFlags(0));
    let turned = picture(Some(&eye), FrameFlags::NORMALS_IN_EYE_SPACE);
    let by_bytes = picture(Some(&bytes), FrameFlags(0));
    assert!(apart(&wanted, &turned) < 0.5, "{}", apart(&wanted, &turned));
    assert!(apart(&wanted, &by_bytes) < 3.0, "{}", apart(&wanted, &by_bytes));
    assert!(apart(&wanted, &picture(Some(&eye), FrameFlags(0))) > 10.0);
    let by_depth = picture(None, FrameFlags(0));
    assert!(apart(&wanted, &by_depth) > 1.0);
    for cleared in [0, 255] {
        let none = host.image(wgpu::TextureFormat::Rgba8Unorm, &vec![cleared; (4 * SIZE.0 * SIZE.1) as usize]);
        let given = SurfaceImages { normals: Some(&none), ..SurfaceImages::default() };
        assert_eq!(shoot(&mut host, camera, &hits, |_| ASPHALT, given), by_depth, "{cleared}");
    }
}

#[test]
fn surface_classes_are_saved_and_change_the_hash() {
    let host = silent();
    let mut context = host.context;
    let bare = context.state_hash().unwrap();
    context.set_default_surface_class(SurfaceClass::Rock);
    let rock = context.state_hash().unwrap();
    context.set_ground_grid(Some(hills::grid(|_| SurfaceClass::Soil))).unwrap();
    let soil = context.state_hash().unwrap();
    let saved = context.save().unwrap();
    let paved = hills::grid(|at| if on_road(at) { SurfaceClass::Paved } else { SurfaceClass::Soil });
    context.set_ground_grid(Some(paved.clone())).unwrap();
    let hashes = [bare, rock, soil, context.state_hash().unwrap()];
    assert!((0..4).all(|i| (0..i).all(|k| hashes[i] != hashes[k])), "{hashes:?}");
    context.set_default_surface_class(SurfaceClass::Unspecified);
    context.load(&saved).unwrap();
    assert_eq!((context.state_hash().unwrap(), context.default_surface_class()), (soil, SurfaceClass::Rock));
    assert!(context.ground_grid().unwrap().classes.iter().all(|c| *c == SurfaceClass::Soil));
}

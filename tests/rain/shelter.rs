//! Shelter from rain, by boxes and by the host's own maps, against f64 rays through the true geometry; moving things
//! included.

use glam::{DMat4, DVec2, DVec3};
use welkin::{
    context::GivenDirection,
    frame::Stages,
    gpu::{Device, DeviceOptions},
    rain::{
        Classes, OccluderMap, RainModel, RainSettings, Shelter, Taken, drops, lattice,
        shelter::sheltered,
        sizes::{DropSizes, SMALLEST_MM, Weight},
        splash::{self, Splashes},
    },
    scene::{Camera, DepthKind, DepthMapping, ViewRays},
    weather::derive,
};
use welkin_support::{
    depth_texture::depth_texture,
    rain_scene::{Host, NEAR_M, rain, upright},
    textures::texture,
};

use crate::pictures::{paint, save};

/// Radiance of the host's picture: far above the light of drops at night, within the range of half floats.
const WHITE: f64 = 3e4;

/// A bridge, a roof on posts and a tunnel on level ground.
pub fn standing() -> Vec<Shelter> {
    let mut all = vec![
        upright([0.0, 9.0, 5.2], [12.0, 3.0, 0.4]),
        upright([-9.0, 9.0, 2.4], [0.6, 3.0, 2.4]),
        upright([9.0, 9.0, 2.4], [0.6, 3.0, 2.4]),
        upright([-7.0, 2.0, 3.0], [2.5, 2.0, 0.1]),
        upright([6.0, 0.5, 3.6], [2.2, 5.0, 0.2]),
        upright([3.9, 0.5, 1.7], [0.1, 5.0, 1.7]),
        upright([8.1, 0.5, 1.7], [0.1, 5.0, 1.7]),
    ];
    all.extend([-9.3, -4.7].iter().flat_map(|x| [0.2, 3.8].map(|y| upright([*x, y, 1.45], [0.05, 0.05, 1.45]))));
    all
}

/// Distance along a ray to the boxes or the ground.
pub fn cast(boxes: &[Shelter], eye: DVec3, d: DVec3) -> Option<f64> {
    let mut best = (d.z < -1e-9).then(|| -eye.z / d.z).filter(|t| *t > 0.0);
    for b in boxes {
        let own = |v: DVec3| b.axes.transpose() * v / b.half_size_m;
        let (o, e) = (own(eye - b.center_m), own(d));
        let (mut near, mut far) = (0.0f64, f64::INFINITY);
        for i in 0..3 {
            let (a, c) = ((-1.0 - o[i]) / e[i], (1.0 - o[i]) / e[i]);
            (near, far) = (near.max(a.min(c)), far.min(a.max(c)));
        }
        if far > near && near > 0.0 && best.is_none_or(|t| near < t) {
            best = Some(near);
        }
    }
    best
}

/// The map of `boxes`, by a ray for each texel.
pub fn map(host: &Host, boxes: &[Shelter], taken: &Taken, size: (u32, u32)) -> wgpu::Texture {
    let camera = Camera { position: DVec3::ZERO, view: DMat4::IDENTITY, projection: taken.clip_from_world };
    let kind = if camera.is_orthographic() { DepthKind::Orthographic } else { DepthKind::Perspective };
    let rays = ViewRays::new(&camera, &DepthMapping { kind, reversed: taken.reversed, clip: taken.clip }).unwrap();
    let up = if taken.first_row_at_minus_y { -1.0 } else { 1.0 };
    let mut depths = Vec::new();
    for y in 0..size.1 {
        for x in 0..size.0 {
            let uv = DVec2::new((f64::from(x) + 0.5) / f64::from(size.0), (f64::from(y) + 0.5) / f64::from(size.1));
            let ndc = DVec2::new(2.0 * uv.x - 1.0, up * (1.0 - 2.0 * uv.y));
            let clip = taken.clip_from_world.inverse();
            let near = clip * ndc.extend(if taken.reversed { 1.0 } else { 0.0 }).extend(1.0);
            let eye = near.truncate() / near.w;
            let d = rays.view_ray(ndc).direction;
            let depth = cast(boxes, eye, d).map_or(if taken.reversed { 0.0 } else { 1.0 }, |t| {
                let p = taken.clip_from_world * (eye + d * t).extend(1.0);
                p.z / p.w
            });
            depths.push(depth as f32);
        }
    }
    depth_texture(&host.device, size, &depths)
}

/// A host at night whose whole picture is white: each pixel shows the share of light that drops and splashes let
/// through.
pub fn white(size: (u32, u32)) -> Host {
    let mut host = Host::new(size);
    host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: -40.0 })).unwrap();
    host.view.set_rain(RainSettings { model: RainModel::Drops, ..RainSettings::default() }).unwrap();
    host
}

/// Draws the host's boxes with walls behind them all; returns the share of light that each pixel lets through.
pub fn through(host: &mut Host, boxes: &[Shelter]) -> Vec<f64> {
    host.boxes = boxes.to_vec();
    for [x, y] in [[400.0, 0.0], [-400.0, 0.0], [0.0, 400.0], [0.0, -400.0]] {
        host.boxes.push(upright([x, y, 0.0], [401.0 - f64::abs(x), 401.0 - f64::abs(y), 2000.0]));
    }
    host.draw(|_, _| [WHITE; 3]);
    host.record(Stages::PREPARE.with(Stages::PARTICLES)).unwrap();
    host.pixels().iter().map(|p| f64::from(p[1]) / WHITE).collect()
}

/// Whether a drop that reached `p` with `velocity` hit any of the boxes on its way; `None` if this differs between
/// places within `slack_m` of `p`.
pub fn surely(boxes: &[Shelter], p: DVec3, velocity: DVec3, slack_m: f64) -> Option<bool> {
    let hit = |p: DVec3| boxes.iter().any(|b| sheltered(b, p, velocity));
    let first = hit(p);
    let f = velocity.normalize();
    let (a, b) = f.any_orthonormal_pair();
    let round = (0..8).map(|i| f64::from(i) * std::f64::consts::FRAC_PI_4).map(|w| a * w.cos() + b * w.sin());
    let all = round.flat_map(|d| [d * slack_m, d * (0.5 * slack_m)]).chain([f * slack_m, -f * slack_m]);
    all.map(|d| hit(p + d)).all(|h| h == first).then_some(first)
}

/// Checks one picture against the rays: every drop whose way is certainly free of `boxes` is drawn, and only such drops
/// make pixels dark; `visible` are the boxes that the picture shows. Returns how many drops were certainly kept off and
/// how many were drawn.
pub fn check(
    host: &mut Host,
    (visible, boxes): (&[Shelter], &[Shelter]),
    classes: &Classes,
    slack_m: f64,
    what: &str,
) -> (u32, u32) {
    let pixels = through(host, visible);
    let clip = host.camera.projection * DMat4::from_mat3(host.camera.rotation());
    let (w, h) = (f64::from(host.size.0), f64::from(host.size.1));
    let t = host.context.time_s();
    let wind = host.context.carrying_wind(t).unwrap();
    let moved = host.context.wind_displacement(t).unwrap();
    let eye = host.camera.position;
    let mut allowed = vec![false; pixels.len()];
    let size = host.size;
    let mark = |allowed: &mut [bool], at: (f64, f64), reach: i32| {
        for (x, y) in (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (at.0 as i32 + x, at.1 as i32 + y))) {
            if x >= 0 && y >= 0 && x < size.0 as i32 && y < size.1 as i32 {
                allowed[(y as u32 * size.0 + x as u32) as usize] = true;
            }
        }
    };
    let (mut dry, mut drawn, mut suspects) = (0, 0, Vec::new());
    let splashes = Splashes::new(classes);
    for landing in splashes.landings(11, eye, t) {
        let at = landing.xy_m.extend(0.0) + DVec3::new(eye.x, eye.y, 0.0);
        let splash_velocity = wind - DVec3::Z * landing.speed_m_s;
        let near = visible.iter().filter(|b| ((at - b.center_m).abs() - b.half_size_m).truncate().max_element() < 0.1);
        // Points on the tops of the boxes, and on sides where the picture shows nothing else.
        let heights = near.flat_map(|b| (0..=20).map(|i| b.center_m.z + b.half_size_m.z * (0.1 * f64::from(i) - 1.0)));
        for z in heights.chain([0.0]) {
            let p = at + DVec3::Z * z;
            let seen = clip * (p - eye).extend(1.0);
            if seen.w > 0.1 && surely(boxes, p + DVec3::Z * 0.02, splash_velocity, slack_m) != Some(true) {
                let at = ((seen.x / seen.w * 0.5 + 0.5) * w, (0.5 - seen.y / seen.w * 0.5) * h);
                mark(&mut allowed, at, (w / seen.w * 0.03).ceil() as i32 + 3);
            }
        }
    }
    for drop in lattice::drops(classes, 11, eye, moved, t) {
        let p = clip * drop.position_m.extend(1.0);
        let ndc = DVec2::new(p.x, p.y) / p.w;
        if drop.share <= 0.0 || p.w < 0.05 || ndc.abs().max_element() > 1.2 {
            continue;
        }
        let speed = f64::from(classes.table[drop.id.1 as usize][1]) * lattice::SPEED_UNIT;
        let free = surely(boxes, eye + drop.position_m, wind - DVec3::Z * speed, slack_m);
        let at = ((ndc.x * 0.5 + 0.5) * w, (0.5 - ndc.y * 0.5) * h);
        let range = cast(visible, eye, drop.position_m.normalize()).unwrap_or(1e9);
        let seen = drop.position_m.length() < range - 0.3;
        if free == Some(true) {
            dry += u32::from(seen && ndc.abs().max_element() < 1.0);
            if seen {
                suspects.push((at, drop));
            }
            continue;
        }
        if free == Some(false) && seen && drop.share > 0.3 && p.w > 0.5 && ndc.abs().max_element() < 0.98 {
            let mut least = 1.0f64;
            for (x, y) in (-2..=2).flat_map(|y| (-2..=2).map(move |x| (at.0 as i32 + x, at.1 as i32 + y))) {
                if x >= 0 && y >= 0 && x < w as i32 && y < h as i32 {
                    least = least.min(pixels[(y as u32 * host.size.0 + x as u32) as usize]);
                }
            }
            assert!(least < 1.0 - 1e-4, "{what}: {:?} at {:?} is not drawn", drop.id, eye + drop.position_m);
            drawn += 1;
        }
        mark(&mut allowed, at, (w / p.w * 0.03).ceil().min(w) as i32 + 3);
    }
    for (i, v) in pixels.iter().enumerate() {
        if *v > 0.97 || allowed[i] {
            continue;
        }
        let at = DVec2::new(f64::from(i as u32 % host.size.0), f64::from(i as u32 / host.size.0));
        let who = suspects.iter().min_by(|a, b| {
            let d = |s: &&((f64, f64), lattice::Drop)| (DVec2::new(s.0.0, s.0.1) - at).length();
            d(a).total_cmp(&d(b))
        });
        panic!(
            "{what}: pixel {at} is dark ({v}); nearest drop that is kept off: {:?}",
            who.map(|(a, d)| (a, d.id, eye + d.position_m))
        );
    }
    (dry, drawn)
}

#[test]
fn no_drop_is_drawn_where_maps_along_the_fall_keep_it_off_whatever_the_wind() {
    let mut host = white((480, 270));
    // Few drops and no splashes; the shutter is so short that drops appear as discs.
    host.view
        .set_rain(RainSettings {
            model: RainModel::Drops,
            shutter_s: 1e-3,
            most_drops: Some(4000),
            ..RainSettings::default()
        })
        .unwrap();
    let side = (512, 512);
    for (i, wind) in [0.0, 5.0, 12.0, 25.0].into_iter().enumerate() {
        let t = 10.0 * (i + 1) as f64;
        let weather = rain(10.0, wind);
        host.context.set_weather(&weather, t, 0.0).unwrap();
        host.context.update(t + 3.0).unwrap();
        let classes = Classes::new(&derive(&weather).unwrap().precipitation, 1.0, 4000);
        let eye = DVec3::new(0.5, -4.0, 1.7);
        let fall = host.context.rain_at(eye, t + 3.0).unwrap().fall_velocity_m_s;
        let half = 20.0;
        let slack = 2.0 * (2.0 * half / f64::from(side.0));
        let boxes = standing();
        // Maps along the fall of median drops and of slower ones. Things below a deck are missing in some of them.
        let falls = [fall.z, -3.4, -2.1].map(|z| DVec3::new(fall.x, fall.y, z).normalize());
        let taken = falls.map(|f| Taken::parallel(DVec3::new(0.0, 4.0, 0.0) - f * 60.0, f, [half; 2], 120.0));
        let textures = taken.map(|t| map(&host, &boxes, &t, side));
        let maps = [0, 1, 2].map(|i| OccluderMap { depth: &textures[i], taken: taken[i] });
        host.context.set_occluder_maps(&maps).unwrap();
        let (mut dry, mut drawn) = (0, 0);
        for (from, to) in [
            (eye, DVec3::new(0.0, 13.0, 1.0)),
            (eye, DVec3::new(6.0, 4.0, 0.5)),
            (DVec3::new(0.0, 6.5, 2.0), DVec3::new(-8.0, 1.0, 1.0)),
        ] {
            host.look(from, to);
            let (a, b) = check(&mut host, (&boxes, &boxes), &classes, slack, &format!("wind {wind}"));
            (dry, drawn) = (dry + a, drawn + b);
        }
        println!("wind {wind}: {dry} drops kept off, {drawn} drawn");
        assert!(dry > 30 && drawn > 30, "wind {wind}: {dry} {drawn}");
    }
}

#[test]
fn a_cab_that_drives_stays_dry_inside() {
    let mut host = white((320, 180));
    let speed = DVec3::Y * 25.0;
    let (mut seen, mut t) = (0, 10.0);
    host.context.set_weather(&rain(60.0, 8.0), t, 0.0).unwrap();
    for k in 0..4 {
        t += 0.37;
        host.context.update(t).unwrap();
        let eye = DVec3::Y * (25.0 * t) + DVec3::new(0.0, 0.0, 2.0);
        host.look(eye, DVec3::new(0.1 * f64::from(k), 1.0, -0.1));
        host.velocity_m_s = speed;
        let cab = Shelter { velocity_m_s: speed, ..upright(eye.to_array(), [1.5, 1.9, 1.5]) };
        host.context.set_shelters(&[cab]).unwrap();
        // Walls of the cab, which is open to the front.
        let wall = |c: [f64; 3], h: [f64; 3]| upright((eye + DVec3::from(c)).to_array(), h);
        let walls = [
            wall([0.0, 0.0, -1.15], [1.3, 1.6, 0.05]),
            wall([-1.25, 0.0, -0.6], [0.05, 1.6, 0.6]),
            wall([1.25, 0.0, -0.6], [0.05, 1.6, 0.6]),
            wall([0.0, 1.55, -0.75], [1.2, 0.05, 0.4]),
        ];
        let pixels = through(&mut host, &walls);
        for (i, v) in pixels.iter().enumerate() {
            let at = DVec2::new(f64::from(i as u32 % 320) + 0.5, f64::from(i as u32 / 320) + 0.5);
            let ndc = DVec2::new(at.x / 160.0 - 1.0, 1.0 - at.y / 90.0);
            let inside = host.cast(ndc).is_some_and(|(p, _)| p.abs().cmplt(DVec3::new(1.3, 1.65, 1.25)).all());
            assert!(!inside || *v == 1.0, "{at}: {v}");
            seen += u32::from(!inside && *v < 0.99);
        }
    }
    assert!(seen > 200, "it rains outside: {seen}");
}

#[test]
fn a_bad_map_is_named_and_the_earlier_maps_stay() {
    let mut host = white((160, 90));
    host.context.set_weather(&rain(60.0, 3.0), 10.0, 0.0).unwrap();
    host.context.update(11.0).unwrap();
    let roof = [upright([0.0, 0.0, 6.0], [40.0, 40.0, 0.2])];
    let taken = Taken::parallel(DVec3::new(0.0, 0.0, 30.0), DVec3::NEG_Z, [38.0; 2], 60.0);
    let good = map(&host, &roof, &taken, (256, 256));
    let one = OccluderMap { depth: &good, taken };
    let open = through(&mut host, &[]);
    host.context.set_occluder_maps(&[one]).unwrap();
    let kept = through(&mut host, &[]);
    assert!(open.iter().any(|v| *v < 0.99) && kept.iter().all(|v| *v == 1.0), "the map keeps the rain off");
    let colour = texture(&host.device, (64, 64), wgpu::TextureFormat::Rgba8Unorm, 1);
    let small = texture(&host.device, (4, 4), wgpu::TextureFormat::R32Float, 1);
    let no_number = Taken { clip_from_world: taken.clip_from_world * f64::NAN, ..taken };
    for (maps, name) in [
        (vec![one; 5], "at most 4"),
        (vec![one, OccluderMap { depth: &colour, taken }], "maps[1].depth.format: Rgba8Unorm"),
        (vec![OccluderMap { depth: &small, taken }], "maps[0].depth.width"),
        (vec![one, one, OccluderMap { depth: &good, taken: no_number }], "maps[2].clip_from_world"),
    ] {
        let e = host.context.set_occluder_maps(&maps).unwrap_err();
        assert!(e.to_string().contains(name), "{}", e);
        assert_eq!(through(&mut host, &[]), kept, "the map before stays: {name}");
    }
    host.context.set_occluder_maps(&[]).unwrap();
    assert!(through(&mut host, &[]).iter().any(|v| *v < 0.99), "it rains again");
}

/// Without compute shaders, on OpenGL as on Vulkan, a map over half of the place keeps that half of the picture dry.
#[test]
fn maps_keep_rain_off_on_both_drivers() {
    for backends in [DeviceOptions::default().backends, wgpu::Backends::GL] {
        let options = DeviceOptions { backends, force_tier0: true, ..DeviceOptions::default() };
        let mut host = Host::on(Device::headless(&options).unwrap(), (160, 90));
        host.context.set_sun(Some(GivenDirection { azimuth_deg: 0.0, elevation_deg: -40.0 })).unwrap();
        host.view.set_rain(RainSettings { model: RainModel::Drops, ..RainSettings::default() }).unwrap();
        host.context.set_weather(&rain(100.0, 0.0), 10.0, 0.0).unwrap();
        host.context.update(11.0).unwrap();
        let west = [upright([-20.0, 0.0, 6.0], [20.0, 40.0, 0.2])];
        let taken = Taken::parallel(DVec3::new(0.0, 0.0, 30.0), DVec3::NEG_Z, [42.0; 2], 60.0);
        let depth = map(&host, &west, &taken, (512, 512));
        host.context.set_occluder_maps(&[OccluderMap { depth: &depth, taken }]).unwrap();
        let pixels = through(&mut host, &[]);
        let dark = |columns: std::ops::Range<usize>| {
            pixels.iter().enumerate().filter(|(i, v)| columns.contains(&(i % 160)) && **v < 0.99).count()
        };
        // Two texels are 0.33 m: some columns in the middle may be dry or wet.
        let (dry, wet) = (dark(0..40), dark(120..160));
        assert!(dry == 0 && wet > 50, "{backends:?}: {dry} {wet}");
    }
}

/// Sets drops few enough to be distinguished.
pub fn few(host: &mut Host, rate: f64, wind: f64, t: f64) -> Classes {
    host.view
        .set_rain(RainSettings {
            model: RainModel::Drops,
            shutter_s: 1e-3,
            most_drops: Some(4000),
            ..RainSettings::default()
        })
        .unwrap();
    let weather = rain(rate, wind);
    host.context.set_weather(&weather, t, 0.0).unwrap();
    host.context.update(t + 3.0).unwrap();
    Classes::new(&derive(&weather).unwrap().precipitation, 1.0, 4000)
}

#[test]
fn splashes_are_as_many_as_the_flux_brings_and_drawn_where_the_twin_has_them() {
    let mut host = white((480, 270));
    let classes = few(&mut host, 3.0, 0.0, 10.0);
    host.view
        .set_rain(RainSettings {
            model: RainModel::Drops,
            shutter_s: 1e-4,
            most_drops: Some(1000),
            ..RainSettings::default()
        })
        .unwrap();
    let splashes = Splashes::new(&classes);
    let eye = DVec3::new(0.2, 0.3, 2.0);
    host.look(eye, DVec3::new(0.0, 1.0, -0.8));
    let clip = host.camera.projection * DMat4::from_mat3(host.camera.rotation());
    let flux: f64 = classes.flux.iter().filter(|f| f.0 >= splash::LEAST_MM).map(|f| f.2).sum();
    assert!(
        (splashes.drawn_per_m2_s / flux - 1.0).abs() < 1e-9 && splashes.left_out_per_m2_s == 0.0,
        "{} {flux} {}",
        splashes.drawn_per_m2_s,
        splashes.left_out_per_m2_s
    );
    let (mut standing, mut visible, mut found) = (0.0, 0u32, 0u32);
    let times = 12;
    for k in 0..times {
        // Moments so far apart that no splash is counted twice.
        let t = 20.0 + 0.31 * f64::from(k);
        host.context.update(t).unwrap();
        let pixels = through(&mut host, &[]);
        for l in splashes.landings(11, eye, t).filter(|l| l.chance < 1.0 && l.xy_m.abs().max_element() < 4.0) {
            standing += 1.0;
            let p = clip * l.xy_m.extend(-eye.z).extend(1.0);
            let at = DVec2::new((p.x / p.w * 0.5 + 0.5) * 480.0, (0.5 - p.y / p.w * 0.5) * 270.0);
            if l.age < 0.6 && at.cmpgt(DVec2::splat(4.0)).all() && at.cmplt(DVec2::new(476.0, 266.0)).all() {
                visible += 1;
                let near = (-2..=2).flat_map(|y| (-2..=2).map(move |x| (at.x as i32 + x, at.y as i32 + y)));
                let least = near.map(|(x, y)| pixels[(y * 480 + x) as usize]).fold(1.0, f64::min);
                found += u32::from(least < 0.999);
            }
        }
    }
    // The expected number of splashes on 64 m^2 at these moments, whose square root is the counting error.
    let want = flux * splash::LIFE_S * 64.0 * f64::from(times);
    println!("{standing} splashes stand, flux x area says {want:.0}; {found} of {visible} are seen");
    assert!((standing - want).abs() < 4.0 * want.sqrt(), "{standing} {want}");
    assert!(visible > 100 && f64::from(found) > 0.97 * f64::from(visible), "{found} of {visible}");
}

/// The ground below a bridge 40 m wide, so wide that some ground stays dry in any wind: by maps of the bridge, and by
/// its box.
#[test]
fn the_wet_wedge_below_a_bridge_is_the_one_that_rays_find() {
    const RAYS: usize = 50;
    let mut host = Host::new((128, 360));
    let deck = [upright([0.0, 0.0, 5.2], [8.0, 20.0, 0.4])];
    for (i, wind) in [0.0, 3.0, 5.0, 12.0, 25.0].into_iter().enumerate() {
        let t = 10.0 * (i + 1) as f64;
        let mut weather = rain(10.0, wind);
        weather.wind.from_deg = 180.0;
        host.context.set_weather(&weather, t, 0.0).unwrap();
        host.context.update(t + 1.0).unwrap();
        let c = derive(&weather).unwrap();
        let sizes = DropSizes::new(&c.precipitation, drops::factor_in(&c.air, 25.0));
        let air = host.context.carrying_wind(t + 1.0).unwrap();
        let fall = |d: f64| air - DVec3::Z * sizes.speed_m_s(d);
        // Drops of as many sizes, each of which brings the same share of the water.
        let shares = std::array::from_fn::<f64, RAYS, _>(|k| (k as f64 + 0.5) / RAYS as f64);
        let falls = sizes.diameters(Weight::Water, SMALLEST_MM, shares).map(fall);
        // Each map is just as large as the deck appears along the fall: along a flat fall the deck is narrow, and so
        // are the texels.
        let above = DVec3::Z * 5.2;
        let taken = sizes.diameters(Weight::Water, SMALLEST_MM, [1.0 / 6.0, 0.5, 5.0 / 6.0]).map(|d| {
            let f = fall(d).normalize();
            Taken::parallel(above - f * 60.0, f, [9.0, 1.0 - 20.5 * f.z], 120.0)
        });
        let textures = taken.map(|k| map(&host, &deck, &k, (256, 512)));
        let maps = [0, 1, 2].map(|k| OccluderMap { depth: &textures[k], taken: taken[k] });
        // The camera looks straight down on the ground; the deck is not in the picture. Grass shows no water film, so
        // that it darkens in proportion to the water that it gets.
        let down = DVec3::new(0.0, 1e-3, -1.0);
        host.camera = Camera::look_to(DVec3::new(0.0, 0.0, 25.0), down, DVec3::Z, 1.5, 128.0 / 360.0, NEAR_M);
        let greens = |host: &mut Host, maps: &[OccluderMap<'_>], boxes: &[Shelter]| -> Vec<f64> {
            host.context.set_occluder_maps(maps).unwrap();
            host.context.set_shelters(boxes).unwrap();
            host.draw(|_, _| [100.0, 2000.0, 100.0]);
            host.record(Stages::PREPARE.with(Stages::SURFACE)).unwrap();
            host.pixels().iter().map(|p| 2000.0 - f64::from(p[1])).collect()
        };
        let open = greens(&mut host, &[], &[]);
        for (by, maps, boxes) in [("maps", &maps[..], &[][..]), ("a box", &[], &deck[..])] {
            let seen = greens(&mut host, maps, boxes);
            // For each row of the picture, which lies across the wind: the number of pixels below the deck, and the
            // water that they get, drawn and true.
            let mut rows = vec![[0.0; 3]; 360];
            // The same numbers for blocks of four by four pixels.
            let mut blocks = vec![[0.0; 3]; 32 * 90];
            for (i, (seen, open)) in seen.iter().zip(&open).enumerate() {
                let (x, y) = (i % 128, i / 128);
                let ndc = DVec2::new((x as f64 + 0.5) / 64.0 - 1.0, 1.0 - (y as f64 + 0.5) / 180.0);
                let at = host.cast(ndc).unwrap().0 + host.camera.position;
                if at.x.abs() < 7.5 && at.y.abs() < 20.0 {
                    let free = falls.iter().filter(|v| !sheltered(&deck[0], at, **v)).count();
                    let row = [1.0, seen / open, free as f64 / RAYS as f64];
                    (0..3).for_each(|k| rows[y][k] += row[k]);
                    (0..3).for_each(|k| blocks[y / 4 * 32 + x / 4][k] += row[k]);
                }
            }
            let sum = |k: usize| rows.iter().map(|r| r[k]).sum::<f64>();
            let (all, wedge, truth) = (sum(0), sum(1), sum(2));
            let off = |r: &[f64; 3]| (r[1] - r[2]) / r[0];
            let worst = rows.iter().filter(|r| r[0] > 0.0).map(|r| off(r).abs()).fold(0.0, f64::max);
            let edge: Vec<f64> =
                blocks.iter().filter(|b| b[0] == 16.0 && (0.8..15.2).contains(&b[2])).map(|b| off(b).powi(2)).collect();
            let grain = (edge.iter().fold(0.0, |sum, v| sum + v) / edge.len().max(1) as f64).sqrt();
            println!(
                "wind {wind}, by {by}: of {all} pixels {wedge:.1} are wet, {truth:.1} by rays; a row is {worst:.3} off at most, \
                 blocks of 16 pixels {grain:.3} RMS"
            );
            assert!(all > 30_000.0 && (wind == 0.0) == (truth == 0.0), "wind {wind}: {truth} of {all}");
            assert!((wedge - truth).abs() <= 0.05 * truth, "wind {wind}, by {by}: {wedge} against {truth}");
            // The picture shows neither bands nor grain.
            assert!(worst < 0.08 && grain < 0.04, "wind {wind}, by {by}: a row is {worst} off, blocks {grain}");
        }
    }
}

/// Saves pictures of the wet wedge below a deck from eye height, by maps and by the box, for people to look at.
#[test]
fn pictures_of_a_wet_wedge_by_maps_and_by_a_box() {
    let mut host = Host::new((640, 360));
    let deck = [upright([0.0, 14.0, 5.2], [30.0, 10.0, 0.4])];
    host.boxes = deck.to_vec();
    let mut weather = rain(10.0, 4.0);
    weather.wind.from_deg = 180.0;
    host.context.set_weather(&weather, 10.0, 0.0).unwrap();
    host.context.update(11.0).unwrap();
    let c = derive(&weather).unwrap();
    let sizes = DropSizes::new(&c.precipitation, drops::factor_in(&c.air, 0.0));
    let air = host.context.carrying_wind(11.0).unwrap();
    let taken = sizes.diameters(Weight::Water, SMALLEST_MM, [1.0 / 6.0, 0.5, 5.0 / 6.0]).map(|d| {
        let f = (air - DVec3::Z * sizes.speed_m_s(d)).normalize();
        Taken::parallel(DVec3::new(0.0, 14.0, 5.0) - f * 60.0, f, [31.0; 2], 120.0)
    });
    let textures = taken.map(|k| map(&host, &deck, &k, (512, 512)));
    let maps = [0, 1, 2].map(|k| OccluderMap { depth: &textures[k], taken: taken[k] });
    host.look(DVec3::new(0.0, 0.0, 1.7), DVec3::new(0.15, 1.0, -0.25));
    let ways: [(&str, &[OccluderMap<'_>], &[Shelter]); 2] = [("maps", &maps, &[]), ("box", &[], &deck)];
    for (name, maps, boxes) in ways {
        host.context.set_occluder_maps(maps).unwrap();
        host.context.set_shelters(boxes).unwrap();
        paint(&host);
        host.record(Stages::ALL).unwrap();
        let pixels = save(&host, &format!("wedge_by_{name}.png"));
        assert!(pixels.iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
    }
}

//! Pictures of flashes.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    context::{Context, ContextDesc, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages, View},
    gpu::readback,
    ground::SurfaceClass,
    light::{Exposure, ToneCurve, luminance, tone::srgb_encode},
    lightning::{FlashKind, FlashTrigger, LightningSettings, StormCell},
    scene::Camera,
    weather::{Surface, SurfaceState, Weather},
};

use crate::device;

/// A camera at night, 2 m over level ground that it looks along to the north.
struct Night {
    context: Context,
    view: View,
    color: wgpu::Texture,
    depth: Option<wgpu::Texture>,
    size: (u32, u32),
    frame_id: u64,
    eye: DVec3,
    forward: DVec3,
}

const NEAR_M: f64 = 0.1;
const FOV_Y: f64 = 1.0;
/// Albedo of the host's ground.
const ALBEDO: f64 = 0.15;

impl Night {
    fn new(weather: &Weather, size: (u32, u32)) -> Self {
        let device = device();
        let shared = Arc::new(Shared::new(&device).unwrap());
        let desc = ContextDesc { sky: welkin_support::coarse_sky::coarse_sky(), seed: 3, ..ContextDesc::default() };
        let mut context = Context::new(device.clone(), shared, desc).unwrap();
        let below = GivenDirection { azimuth_deg: 120.0, elevation_deg: -40.0 };
        context.set_sun(Some(below)).unwrap();
        context.set_moon(Some(below)).unwrap();
        context.set_weather(weather, 0.0, 0.0).unwrap();
        // Flashes are those that a test triggers.
        context.set_lightning(LightningSettings { flashes_per_minute: Some(0.0), ..Default::default() }).unwrap();
        let view = View::new(&context).unwrap();
        let color = welkin_support::textures::texture(&device, size, wgpu::TextureFormat::Rgba32Float, 1);
        Self {
            context,
            view,
            color,
            depth: None,
            size,
            frame_id: 0,
            eye: DVec3::Z * 2.0,
            forward: DVec3::new(0.0, 1.0, 0.25),
        }
    }

    fn camera(&self) -> Camera {
        let aspect = f64::from(self.size.0) / f64::from(self.size.1);
        Camera::look_to(self.eye, self.forward, DVec3::Z, FOV_Y, aspect, NEAR_M)
    }

    /// Sets the host's depth from `range`, the distance along a ray, m.
    fn set_depth(&mut self, range: impl Fn(DVec3) -> f64) {
        let camera = self.camera();
        let (w, h) = self.size;
        let forward = self.forward.normalize();
        let mut depths = Vec::new();
        for y in 0..h {
            for x in 0..w {
                let d = ray(&camera, (x, y), self.size);
                depths.push((NEAR_M / (range(d) * d.dot(forward))) as f32);
            }
        }
        self.depth = Some(welkin_support::depth_texture::depth_texture(&device(), self.size, &depths));
    }

    fn set_ground(&mut self) {
        let height = self.eye.z;
        self.set_depth(|d| if d.z < 0.0 { -height / d.z } else { f64::INFINITY });
    }

    /// A picture at a time, cd/m^2 a channel, over what the host drew.
    fn take_over(&mut self, time_s: f64, stages: Stages, flags: FrameFlags, host: &[f32]) -> Vec<[f64; 3]> {
        self.context.update(time_s).unwrap();
        self.frame_id += 1;
        let device = device();
        let rows =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * self.size.0), rows_per_image: None };
        device.queue.write_texture(self.color.as_image_copy(), bytemuck::cast_slice(host), rows, self.color.size());
        let mut frame = Frame::new(self.frame_id, self.camera(), &self.color, self.depth.as_ref());
        frame.exposure = Some(Exposure::Factor(1e-3));
        frame.flags = flags;
        self.view.record(&self.context, &frame, stages).unwrap();
        let texels = readback::rgba(&device, &self.color).unwrap();
        texels.iter().map(|t| [0, 1, 2].map(|k| f64::from(t[k]))).collect()
    }

    fn take(&mut self, time_s: f64) -> Vec<[f64; 3]> {
        let black = vec![0.0; 4 * (self.size.0 * self.size.1) as usize];
        self.take_over(time_s, ALL, FrameFlags(0), &black)
    }

    fn pure(&mut self, time_s: f64) -> Vec<[f64; 3]> {
        let black = vec![0.0; 4 * (self.size.0 * self.size.1) as usize];
        self.take_over(time_s, ALL, FrameFlags::NO_HISTORY, &black)
    }
}

const ALL: Stages = Stages(Stages::BACKGROUND.0 | Stages::SURFACE.0 | Stages::MEDIUM.0 | Stages::PARTICLES.0);

fn ray(camera: &Camera, (x, y): (u32, u32), (w, h): (u32, u32)) -> DVec3 {
    let ndc = [2.0 * (f64::from(x) + 0.5) / f64::from(w) - 1.0, 1.0 - 2.0 * (f64::from(y) + 0.5) / f64::from(h)];
    let p = &camera.projection;
    let own = DVec3::new(ndc[0] / p.x_axis.x, ndc[1] / p.y_axis.y, -1.0);
    let view = glam::DMat3::from_mat4(camera.view);
    (view.transpose() * own).normalize()
}

fn mean(picture: &[[f64; 3]]) -> f64 {
    picture.iter().map(luminance).sum::<f64>() / picture.len() as f64
}

fn most(picture: &[[f64; 3]]) -> f64 {
    picture.iter().map(luminance).fold(0.0, f64::max)
}

fn at(time_s: f64, position: DVec3, kind: FlashKind) -> FlashTrigger {
    FlashTrigger { time_s, position, kind, peak_ka: Some(30.0), strokes: Some(3) }
}

const AHEAD: DVec3 = DVec3::new(200.0, 3000.0, 0.0);

#[test]
fn frames_of_any_rate_draw_the_same_light() {
    for (kind, report) in [
        (FlashKind::ToGround, "LOWI 121150Z 00000KT CAVOK 18/12 Q1015"),
        (FlashKind::InCloud, "LOWI 121150Z 00000KT 9999 OVC030CB 18/12 Q1015"),
    ] {
        let weather = Weather::from_metar(report).unwrap().weather;
        let sum = |hz: f64| {
            let mut night = Night::new(&weather, (48, 27));
            night.context.trigger_flash(&at(1.0, AHEAD, kind)).unwrap();
            let dark = mean(&night.take(0.5));
            let frames = (1.2 * hz) as i32;
            let sum: f64 = (0..=frames).map(|i| (mean(&night.take(0.9 + f64::from(i) / hz)) - dark) / hz).sum();
            assert!(sum > 0.0, "{kind:?} nothing is drawn at {hz}");
            sum
        };
        let [slow, middle, fast] = [30.0, 60.0, 144.0].map(sum);
        println!("{kind:?}: {slow} {middle} {fast}");
        assert!((slow / fast - 1.0).abs() < 0.02 && (middle / fast - 1.0).abs() < 0.02, "{slow} {middle} {fast}");
    }
}

#[test]
fn a_line_sends_the_same_light_at_any_resolution() {
    let weather = Weather::from_metar("LOWI 121150Z 00000KT CAVOK 18/12 Q1015").unwrap().weather;
    let of = |size| {
        let mut night = Night::new(&weather, size);
        night.context.trigger_flash(&at(1.0, AHEAD, FlashKind::ToGround)).unwrap();
        let dark = mean(&night.pure(0.5));
        mean(&night.pure(1.01)) - dark
    };
    let [small, large] = [(64, 36), (384, 216)].map(of);
    println!("{small} {large}");
    assert!(small > 0.0 && (small / large - 1.0).abs() < 0.03, "{small} {large}");
}

#[test]
fn what_the_host_drew_hides_the_line() {
    let weather = Weather::from_metar("LOWI 121150Z 00000KT CAVOK 18/12 Q1015").unwrap().weather;
    let mut night = Night::new(&weather, (96, 54));
    night.context.trigger_flash(&at(1.0, AHEAD, FlashKind::ToGround)).unwrap();
    night.context.trigger_flash(&at(5.0, AHEAD, FlashKind::ToGround)).unwrap();
    night.set_depth(|_| 4500.0);
    let before = most(&night.pure(1.01));
    night.set_depth(|_| 500.0);
    let behind = most(&night.pure(5.01));
    assert!(before > 1e3 && behind < 0.01 * before, "{before} {behind}");
}

#[test]
fn without_a_flash_nothing_is_drawn_and_nothing_is_paid() {
    let weather = Weather::preset("thunderstorm").unwrap();
    let mut quiet = Night::new(&weather, (96, 54));
    let mut stormy = Night::new(&weather, (96, 54));
    quiet.set_ground();
    stormy.set_ground();
    stormy.context.set_lightning(LightningSettings::default()).unwrap();
    let all = stormy.context.flashes_near(DVec3::ZERO, (0.0, 60.0), 50_000.0).unwrap();
    let shines = |t: f64| all.iter().any(|f| (f.time_s - 0.2..f.time_s + 4.1).contains(&t));
    let dark = (0..600).map(|i| f64::from(i) * 0.1).find(|t| !shines(*t));
    // With many cells one nearly always flashes somewhere; a single cell has pauses.
    let cell = StormCell { position: DVec3::ZERO, radius_m: 3000.0, flashes_per_minute: 2.0 };
    let own = LightningSettings { cells: vec![cell], ..Default::default() };
    let dark_s = dark.unwrap_or_else(|| {
        stormy.context.set_lightning(own.clone()).unwrap();
        let all = stormy.context.flashes_near(DVec3::ZERO, (0.0, 300.0), 50_000.0).unwrap();
        let shines = |t: f64| all.iter().any(|f| (f.time_s - 0.2..f.time_s + 4.1).contains(&t));
        (50..3000).map(|i| f64::from(i) * 0.1).find(|t| !shines(*t)).expect("a pause")
    });
    let (a, b) = (quiet.pure(dark_s), stormy.pure(dark_s));
    assert_eq!(a, b, "bit for bit");
    assert_eq!(quiet.view.report().passes, stormy.view.report().passes);
    let near = at(dark_s + 5.0, DVec3::new(0.0, 800.0, 0.0), FlashKind::ToGround);
    stormy.context.trigger_flash(&near).unwrap();
    let shown = stormy.pure(near.time_s + 0.01);
    assert!(mean(&shown) > 2.0 * mean(&b), "then it flashes");
}

#[test]
fn views_agree_and_time_may_run_back() {
    let weather = Weather::preset("thunderstorm").unwrap();
    let [mut one, mut other] = [(); 2].map(|()| Night::new(&weather, (96, 54)));
    let state = one.context.save().unwrap();
    let flash = at(3.0, DVec3::new(0.0, 800.0, 0.0), FlashKind::ToGround);
    one.context.trigger_flash(&flash).unwrap();
    other.context.trigger_flash(&flash).unwrap();
    let with_flash = one.context.save().unwrap();
    (0..20).for_each(|i| drop(one.take(2.0 + f64::from(i) * 0.05)));
    let first = one.pure(3.01);
    assert_eq!(first, other.pure(3.01));
    one.take(10.0);
    one.context.load(&with_flash).unwrap();
    // The frame's number decides only dither and drops.
    one.frame_id = 20;
    assert_eq!(first, one.pure(3.01), "the same flash again");
    one.context.load(&state).unwrap();
    assert!(mean(&one.pure(3.01)) < 0.5 * mean(&first), "a state without it has none");
}

/// Rain and wet ground are lit by a flash as by a lamp.
#[test]
fn rain_and_wet_ground_are_lit() {
    let weather = Weather::preset("thunderstorm").unwrap();
    let mut night = Night::new(&weather, (96, 54));
    night.forward = DVec3::new(0.0, 1.0, -0.3);
    night.set_ground();
    night.context.trigger_flash(&at(3.0, DVec3::new(0.0, 900.0, 0.0), FlashKind::InCloud)).unwrap();
    let dark = night.pure(1.0);
    let lit = night.pure(3.01);
    let black = vec![0.0; dark.len() * 4];
    let wet = |night: &mut Night, t| night.take_over(t, Stages::SURFACE, FrameFlags::NO_HISTORY, &black);
    let rain = |night: &mut Night, t| night.take_over(t, Stages::PARTICLES, FrameFlags::NO_HISTORY, &black);
    night.context.trigger_flash(&at(9.0, DVec3::new(0.0, 900.0, 0.0), FlashKind::InCloud)).unwrap();
    let (ground, drops) = (mean(&wet(&mut night, 8.0)), mean(&rain(&mut night, 8.0)));
    let (ground_lit, drops_lit) = (mean(&wet(&mut night, 9.01)), mean(&rain(&mut night, 9.01)));
    println!("ground {ground} {ground_lit}, drops {drops} {drops_lit}");
    assert!(mean(&lit) > 5.0 * mean(&dark));
    assert!(ground_lit > 5.0 * ground && drops_lit > 5.0 * drops, "{ground} {ground_lit}, {drops} {drops_lit}");
}

/// Wet plants do not mirror, and a flash in the sky does not change that.
#[test]
fn a_flash_leaves_wet_plants_dark() {
    let wet = Surface { state: Some(SurfaceState::Wet), ..Surface::default() };
    let weather = Weather { surface: wet, ..Weather::default() };
    let most_of = |class| {
        let mut night = Night::new(&weather, (64, 36));
        night.context.set_default_surface_class(class);
        night.forward = DVec3::new(0.0, 1.0, -0.3);
        night.set_ground();
        night.context.trigger_flash(&at(1.0, AHEAD, FlashKind::InCloud)).unwrap();
        let black = vec![0.0; 4 * 64 * 36];
        let picture = night.take_over(1.01, Stages::SURFACE, FrameFlags::NO_HISTORY, &black);
        assert!(picture.iter().flatten().all(|v| v.is_finite()), "{class:?}");
        most(&picture)
    };
    let soil = most_of(SurfaceClass::Soil);
    for class in [SurfaceClass::Vegetation, SurfaceClass::Water, SurfaceClass::Rock, SurfaceClass::Unspecified] {
        let found = most_of(class);
        println!("{class:?}: {found} cd/m^2, of soil {soil}");
        assert!(found <= 20.0 * soil, "{class:?}: {found}, of soil {soil}");
    }
}

/// Returns the times at which rises and falls by more than a tenth of the brighter luminance end.
fn changes(luminances: &[(f64, f64)]) -> Vec<f64> {
    let (mut out, mut low, mut high) = (Vec::new(), luminances[0].1, luminances[0].1);
    let mut rising = None;
    for &(t, y) in luminances {
        low = low.min(y);
        high = high.max(y);
        if rising != Some(true) && y > low * 1.1 {
            out.push(t);
            (rising, high) = (Some(true), y);
        } else if rising != Some(false) && y < high * 0.9 {
            out.push(t);
            (rising, low) = (Some(false), y);
        }
        if rising == Some(true) {
            low = y.max(low).min(y);
        } else {
            high = y;
        }
    }
    out
}

#[test]
fn viewers_whom_flicker_may_harm_see_three_changes_a_second_at_most() {
    let weather = Weather::from_metar("LOWI 121150Z 00000KT 9999 OVC030CB 18/12 Q1015").unwrap().weather;
    let cell = StormCell { position: DVec3::new(0.0, 4000.0, 0.0), radius_m: 2000.0, flashes_per_minute: 60.0 };
    let busiest = |limits_flicker: bool| {
        let mut night = Night::new(&weather, (16, 9));
        let settings = LightningSettings { cells: vec![cell], limits_flicker, ..Default::default() };
        night.context.set_lightning(settings).unwrap();
        let events = night.context.flashes_near(DVec3::ZERO, (0.0, 20.0), 20_000.0).unwrap();
        let seen: Vec<(f64, f64)> = (0..1200).map(|i| f64::from(i) / 60.0).map(|t| (t, mean(&night.take(t)))).collect();
        let times = changes(&seen);
        let count = |from: f64| times.iter().filter(|t| (from..from + 1.0).contains(*t)).count();
        let light: f64 = seen.iter().map(|s| s.1).sum();
        (times.iter().map(|t| count(*t)).max().unwrap_or(0), events, light)
    };
    let (natural, natural_events, _) = busiest(false);
    let (limited, limited_events, light) = busiest(true);
    println!("changes in a second: {natural} as in nature, {limited} limited");
    assert!(natural > 3 && (2..=3).contains(&limited), "{natural} {limited}");
    assert!(light > 0.0);
    assert_eq!(natural_events, limited_events, "the schedule stays");
}

/// WELKIN_LIGHTNING_PICTURES=<folder> writes pictures to look at.
#[test]
fn pictures_to_look_at() {
    let Some(folder) = std::env::var_os("WELKIN_LIGHTNING_PICTURES") else { return };
    let fair = Weather::from_metar("LOWI 121150Z 00000KT CAVOK 18/12 Q1015").unwrap().weather;
    let dry = Weather::from_metar("LOWI 121150Z 00000KT 9999 OVC040CB 18/12 Q1015").unwrap().weather;
    let rain = Weather::from_metar("LOWI 121150Z 24008KT 5000 TSRA OVC030CB 18/16 Q1008").unwrap().weather;
    let high = Weather::from_metar("LOWI 121150Z 00000KT 9999 OVC080CB 18/12 Q1015").unwrap().weather;
    let heavy = Weather::preset("thunderstorm").unwrap();
    let near = DVec3::new(-300.0, 1200.0, 0.0);
    for (name, weather, position, kind, ev) in [
        ("dry_ground", &dry, AHEAD, FlashKind::ToGround, 9.0),
        ("dry_cloud", &dry, AHEAD, FlashKind::InCloud, 9.0),
        ("rain_ground", &rain, AHEAD, FlashKind::ToGround, 9.0),
        ("rain_cloud", &rain, AHEAD, FlashKind::InCloud, 9.0),
        ("heavy_near", &heavy, near, FlashKind::ToGround, 9.0),
        ("high_ground", &high, AHEAD, FlashKind::ToGround, 9.0),
        ("fair", &fair, AHEAD, FlashKind::ToGround, 9.0),
    ] {
        let mut night = Night::new(weather, (640, 360));
        night.set_ground();
        night.context.trigger_flash(&at(2.0, position, kind)).unwrap();
        let camera = night.camera();
        for (k, t) in [1.995, 2.012].into_iter().enumerate() {
            let mut host = Vec::new();
            for y in 0..360 {
                for x in 0..640 {
                    let d = ray(&camera, (x, y), night.size);
                    let at = night.eye - d * (night.eye.z / d.z.min(-1e-3));
                    let lit = d.z < 0.0 && (at - night.eye).length() < 20_000.0 && x % 16 == 0 && y % 8 == 0;
                    let lux = if lit { night.context.lightning_at(at, t, 1.0 / 60.0).unwrap().level_lux } else { 0.0 };
                    host.extend([(lux * ALBEDO / std::f64::consts::PI) as f32; 3]);
                    host.push(1.0);
                }
            }
            let whole: Vec<f32> = (0..640 * 360)
                .flat_map(|i| {
                    let from = (i / 640 / 8 * 8) * 640 + (i % 640) / 16 * 16;
                    host[4 * from..4 * from + 4].to_vec()
                })
                .collect();
            let picture = night.take_over(t, ALL, FrameFlags::NO_HISTORY, &whole);
            let exposure = Exposure::Ev100(ev).factor(1.0);
            let bytes: Vec<u8> = picture
                .iter()
                .flatten()
                .map(|v| (255.0 * srgb_encode(ToneCurve::Filmic.apply(v * exposure))).round() as u8)
                .collect();
            let path = std::path::Path::new(&folder).join(format!("{name}_{k}.ppm"));
            let mut file = b"P6 640 360 255\n".to_vec();
            file.extend(bytes);
            std::fs::write(path, file).unwrap();
            println!("{name} {k}: mean {:.4} most {:.1} cd/m^2", mean(&picture), most(&picture));
        }
    }
}

/// Between clouds nothing glows, and of clouds most where the flash is.
#[test]
fn a_flash_lights_the_clouds_about_it_and_not_the_gaps_between_them() {
    let weather = Weather::from_metar("LOWI 121150Z 00000KT 9999 SCT030 18/12 Q1015").unwrap().weather;
    let mut night = Night::new(&weather, (96, 54));
    night.context.set_cloud_model(CloudModel::Volume);
    (night.forward, night.depth) = (DVec3::new(0.0, 1.0, 0.45), None);
    let camera = night.camera();
    let mut bearings = Vec::new();
    for (i, east_m) in [-3500.0, 0.0, 3500.0].into_iter().enumerate() {
        let (time_s, flash) = (1.0 + 10.0 * i as f64, DVec3::new(east_m, 6000.0, 0.0));
        night.context.trigger_flash(&at(time_s, flash, FlashKind::InCloud)).unwrap();
        let (dark, lit) = (night.pure(time_s - 0.5), night.pure(time_s + 0.01));
        let glow: Vec<f64> = lit.iter().zip(&dark).map(|(lit, dark)| luminance(lit) - luminance(dark)).collect();
        // The mean direction of the glow; its brightest pixel would be that of some edge.
        let of = |(i, glow): (usize, &f64)| ray(&camera, (i as u32 % 96, i as u32 / 96), night.size) * glow.max(0.0);
        let toward: DVec3 = glow.iter().enumerate().map(of).sum();
        let bearing = |v: DVec3| v.x.atan2(v.y).to_degrees();
        let mut sorted = glow.clone();
        sorted.sort_by(f64::total_cmp);
        let most = sorted[sorted.len() - 1];
        let at = |share: f64| sorted[(sorted.len() as f64 * share) as usize] / most;
        println!(
            "glow of {most:.2} cd/m^2 toward {:.0} deg of a flash toward {:.0}; a tenth of the picture below {:.1e} of it, half below {:.4}",
            bearing(toward),
            bearing(flash),
            at(0.1),
            at(0.5)
        );
        bearings.push([bearing(toward), bearing(flash)]);
        assert!(at(0.1) < 0.01 && at(0.5) < 0.05, "{} {}", at(0.1), at(0.5));
    }
    // Single clouds shift the glow. On average it lies in the direction of the flash, and moves from one flash to the
    // next.
    let off = bearings.iter().map(|[glow, flash]| glow - flash).sum::<f64>() / 3.0;
    assert!(off.abs() < 15.0 && bearings.windows(2).all(|pair| pair[1][0] > pair[0][0] + 5.0), "{off}: {bearings:?}");
}

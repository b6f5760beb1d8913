//! The scenes: every kind of weather, light, image, depth, camera and call that affects a picture.

use std::sync::Arc;

use glam::{DMat4, DVec2, DVec3};
use welkin::{
    Result,
    context::Context,
    fog::{
        CompatibilityLaw, DistanceKind, FogLayer, Law, Patches, Phase, Profile, koschmieder_extinction_per_m,
        laws::Curve,
    },
    frame::{Exposure, FrameFlags, Stages, ToneCurve},
    glass::{Pane, Windscreen, WiperArm},
    gpu::Device,
    ground::{GroundModel, SurfaceClass},
    rain::{AreaMotion, AreaRain, AreaShape, OccluderMap, RainArea, RainModel, RainSettings, Taken},
    scene::{Axes, ClipSpace, HostLight, Place, WorldFrame, WorldKind},
    sky::{SkyModel, SkySettings},
    weather::{CloudKind, CloudLayer, Precipitation, PrecipitationKind, Surface, SurfaceState, Weather, Wind},
    wind::{WindGrid, WindGridKind},
};

use super::{
    host::uploaded,
    scene::{Depth, Dress, Normals, Scene, Target},
    world::{World, hill_grid, shelters},
};

/// Name of a lighting, azimuth and elevation of the sun, and of the moon.
type Lights = (&'static str, [f64; 2], Option<[f64; 2]>);

const LIGHTS: [Lights; 4] = [
    ("day", [140.0, 40.0], None),
    ("low-sun", [10.0, 4.0], None),
    ("moon", [300.0, -30.0], Some([20.0, 25.0])),
    ("dark", [300.0, -30.0], None),
];

/// Exposure for a night with lamps.
const LIT: Option<Exposure> = Some(Exposure::Ev100(3.0));

/// All scenes, each with a unique name.
///
/// # Errors
/// Presets and reports that Welkin does not know.
pub fn scenes() -> Result<Vec<Scene>> {
    let mut all = Vec::new();
    for preset in Weather::preset_names() {
        for (light, sun, moon) in LIGHTS {
            all.push(Scene { sun, moon, ..Scene::preset(&format!("preset-{preset}-{light}"), preset)? });
        }
    }
    for part in [reports, stages, images, skies, fogs, falling, shelter, glass, ground, channels] {
        all.extend(part()?);
    }
    Ok(all)
}

fn reports() -> Result<Vec<Scene>> {
    [
        ("overcast", "EDDF 211020Z 24008KT 9999 OVC012 12/09 Q1013"),
        ("broken", "EDDF 211020Z 24012G25KT 7000 SHRA BKN030CB 14/11 Q1003"),
        ("fog", "EDDF 210550Z 00000KT 0150 R25/0300 FG VV001 04/04 Q1021"),
        ("haze", "OMDB 211000Z 32006KT 3000 HZ NSC 38/18 Q1002"),
        ("freezing-rain", "EDDF 210550Z 09006KT 3000 FZRA OVC008 M02/M03 Q0998"),
    ]
    .into_iter()
    .map(|(name, text)| Ok(Scene::new(&format!("metar-{name}"), Weather::from_metar(text)?.weather)))
    .collect()
}

/// Rain on wet ground below broken cloud by day, so that every stage has something to draw.
fn rain_by_day(name: &str) -> Result<Scene> {
    Ok(Scene { classes: true, ..Scene::preset(name, "rain")? })
}

fn stages() -> Result<Vec<Scene>> {
    use Stages as S;
    let each = [S::PREPARE, S::BACKGROUND, S::SURFACE, S::MEDIUM, S::PARTICLES, S::LENS, S::TONE];
    let glass = |s: Scene| Scene { windscreen: Some(quad), flags: FrameFlags(0), frames_before: 40, ..s };
    let halves =
        vec![S::PREPARE.with(S::BACKGROUND).with(S::SURFACE), S::MEDIUM.with(S::PARTICLES), S::LENS.with(S::TONE)];
    let mut all = vec![
        Scene { calls: each.to_vec(), ..glass(rain_by_day("stages-apart")?) },
        glass(rain_by_day("stages-together")?),
        Scene { calls: halves, ..glass(rain_by_day("stages-in-three")?) },
        Scene { calls: vec![S::MEDIUM.with(S::TONE)], ..Scene::preset("stages-medium-tone", "mist")? },
        Scene { calls: vec![S::BACKGROUND.with(S::TONE)], ..Scene::preset("stages-background-tone", "clear")? },
        Scene { calls: vec![S::SURFACE.with(S::TONE)], ..rain_by_day("stages-surface-tone")? },
        Scene { calls: vec![S::PREPARE, S::PARTICLES.with(S::TONE)], ..rain_by_day("stages-particles-tone")? },
        Scene { calls: vec![S::TONE], ..rain_by_day("stages-tone")? },
    ];
    for (name, tone) in [("linear", ToneCurve::Linear), ("filmic", ToneCurve::Filmic)] {
        all.push(Scene { tone, ..Scene::preset(&format!("tone-{name}"), "scattered")? });
    }
    Ok(all)
}

fn images() -> Result<Vec<Scene>> {
    use wgpu::TextureFormat as F;
    let mut all = Vec::new();
    for depth in Depth::ALL {
        let above = depth == Depth::Orthographic;
        let (eye, elevation) =
            if above { (DVec3::new(0.0, 20.0, 60.0), -55.0) } else { (DVec3::new(0.0, 0.0, 2.2), 2.0) };
        for samples in [[1, 1], [4, 4], [1, 4]] {
            let name = format!("depth-{depth:?}-{}-{}", samples[0], samples[1]).to_lowercase();
            let scene = Scene { depth, samples, eye, elevation, ..rain_by_day(&name)? };
            all.push(scene);
        }
    }
    for format in [F::Depth16Unorm, F::Depth24Plus, F::Depth24PlusStencil8] {
        let name = format!("depth-format-{format:?}").to_lowercase();
        all.push(Scene { depth_format: format, depth: Depth::Standard, ..rain_by_day(&name)? });
    }
    for (name, target) in [
        ("scene-linear", Target::SceneLinear),
        ("display-linear", Target::DisplayLinear),
        ("srgb-view", Target::SrgbView),
        ("srgb-bytes", Target::SrgbBytes),
    ] {
        all.push(Scene { target, ..rain_by_day(&format!("space-{name}"))? });
        let [_, _, (_, sun, moon), _] = LIGHTS;
        all.push(Scene { target, sun, moon, ..Scene::preset(&format!("space-{name}-night"), "mist")? });
    }
    all.push(Scene { samples: [4, 4], target: Target::SrgbView, ..rain_by_day("space-srgb-view-4")? });
    all.push(Scene { bottom_left: true, ..rain_by_day("bottom-left")? });
    all.push(Scene { masked: true, ..rain_by_day("masked")? });
    Ok(all)
}

fn skies() -> Result<Vec<Scene>> {
    let mut all = Vec::new();
    for (name, model) in SkyModel::NAMES {
        for (light, sun, _) in &LIGHTS[..2] {
            let coarse = Scene::new(&format!("sky-{name}-{light}"), Weather::preset("hazy")?);
            all.push(Scene { sky: SkySettings { model, ..coarse.sky }, sun: *sun, ..coarse });
        }
    }
    let spectral = Scene::new("sky-spectral", Weather::default());
    all.push(Scene { sky: SkySettings { wavelengths: 6, ..spectral.sky }, sun: [10.0, 4.0], ..spectral });
    all.push(Scene { sky: SkySettings::default(), sun: [10.0, 4.0], ..Scene::new("sky-default", Weather::default()) });
    let still = Scene::new("sky-refining", Weather::preset("hazy")?);
    all.push(Scene { flags: FrameFlags(0), frames_before: 8, ..still });
    let turned = Scene {
        weather: vec![(Weather::default(), 0.0, 0.0), (Weather::preset("smoke")?, 5.0, 10.0)],
        ..all[0].clone()
    };
    all.push(Scene { name: "sky-changing".into(), flags: FrameFlags(0), frames_before: 12, frame_s: 0.4, ..turned });
    let place = Place { latitude_deg: 47.0, longitude_deg: 11.0, altitude_m: 0.0 };
    let tangent = WorldFrame { kind: WorldKind::Tangent, origin: place, ..WorldFrame::default() };
    let ecef = WorldFrame { kind: WorldKind::Ecef, ..tangent };
    for (name, up, elevation, frame) in [
        ("sea", 2.0, 5.0, WorldFrame::default()),
        ("airliner", 11_000.0, -4.0, tangent),
        ("stratosphere", 35_000.0, -6.0, ecef),
        ("orbit", 400_000.0, -18.0, ecef),
        ("far-space", 6_000_000.0, -60.0, ecef),
    ] {
        for (light, sun, _) in &LIGHTS[..2] {
            let weather = Weather::preset("scattered")?;
            let scene = Scene::new(&format!("height-{name}-{light}"), weather);
            let (world, eye) = (World::Nothing, DVec3::Z * up);
            all.push(Scene { world, eye, elevation, frame, sun: *sun, ..scene });
        }
    }
    let y_up = WorldFrame {
        axes: Axes::YUp,
        kind: WorldKind::Tangent,
        grid_bearing_deg: 30.0,
        origin: place,
        ..WorldFrame::default()
    };
    all.push(Scene { frame: y_up, normals: Normals::World, ..rain_by_day("y-up")? });
    Ok(all)
}

fn fogs() -> Result<Vec<Scene>> {
    let ground_fog = FogLayer::ground_fog(koschmieder_extinction_per_m(300.0), 30.0, 10.0);
    let patches = Patches { amount: 1.0, size_m: 90.0, seed: 7, drift_m: [20.0, -10.0] };
    let curve =
        |curve, distance, colour, sky_band| Law::Compatibility(CompatibilityLaw { curve, distance, colour, sky_band });
    let squared = Curve::ExponentialSquared { density_per_m: 1.0 / 600.0 };
    let dust = Phase::HenyeyGreenstein { g: 0.7 };
    let between = Phase::Between { diameter_um: 15.0, g: 0.7, share: 0.4 };
    let thinning = Profile::Exponential { reference_m: 0.0, scale_height_m: 60.0 };
    let laws = [
        ("clear", Law::Clear),
        ("layer", Law::Layer(ground_fog)),
        ("patches", Law::Layer(FogLayer { patches: Some(patches), ..ground_fog })),
        ("dust", Law::Layer(FogLayer { albedo: [0.96, 0.9, 0.8], phase: dust, angstrom: 1.0, ..ground_fog })),
        ("between", Law::Layer(FogLayer { phase: between, profile: thinning, ..ground_fog })),
        ("linear", curve(Curve::Linear { start_m: 20.0, end_m: 600.0 }, DistanceKind::Plane, None, 0.3)),
        (
            "exponential",
            curve(
                Curve::Exponential { density_per_m: 1.0 / 400.0 },
                DistanceKind::Range,
                Some([2000.0, 2500.0, 3000.0]),
                0.1,
            ),
        ),
        ("squared", curve(squared, DistanceKind::Range, None, std::f64::consts::PI)),
    ];
    let mut all = Vec::new();
    for (name, law) in laws {
        for (light, sun, moon) in &LIGHTS[1..3] {
            let scene = Scene::preset(&format!("fog-{name}-{light}"), "broken")?;
            all.push(Scene { law: Some(law), sun: *sun, moon: *moon, ..scene });
        }
    }
    let above = Scene { eye: DVec3::new(0.0, 0.0, 60.0), elevation: -8.0, ..Scene::preset("fog-from-above", "fog")? };
    let inside =
        Scene { eye: DVec3::new(0.0, 0.0, 0.6), elevation: 0.0, ..Scene::preset("fog-knee-deep", "shallow_fog")? };
    let depth = Depth::Logarithmic;
    all.extend([Scene { depth, name: "fog-logarithmic".into(), ..inside.clone() }, above, inside]);
    let coming = vec![(Weather::preset("clear")?, 0.0, 0.0), (Weather::preset("fog")?, 0.0, 20.0)];
    all.push(Scene { weather: coming, ..Scene::preset("fog-coming", "fog")? });
    Ok(all)
}

fn lamps(_: &Arc<Device>, context: &mut Context) -> Result<()> {
    let lamp = |x: f64| HostLight {
        position_m: DVec3::new(x, 0.5, 1.2),
        direction: DVec3::new(0.02 * x, 1.0, -0.04),
        intensity_cd: [30_000.0, 29_000.0, 26_000.0],
        inner_deg: 4.0,
        outer_deg: 18.0,
    };
    let bulb = HostLight { position_m: DVec3::new(4.0, 14.0, 4.0), inner_deg: 180.0, outer_deg: 180.0, ..lamp(0.0) };
    context.set_lights(&[lamp(-0.8), lamp(0.8), HostLight { intensity_cd: [800.0, 500.0, 300.0], ..bulb }])
}

fn areas(_: &Arc<Device>, context: &mut Context) -> Result<()> {
    let shower = |center_m, shape, rate_mm_h| RainArea {
        center_m,
        shape,
        rim_m: 250.0,
        rate_mm_h,
        kind: AreaRain::Showers,
        motion: AreaMotion::Own([3.0, -2.0]),
        ..RainArea::default()
    };
    let mut corners = [[0.0; 2]; welkin::rain::MAX_CORNERS];
    corners[..4].copy_from_slice(&[[-900.0, -300.0], [800.0, -400.0], [1000.0, 500.0], [-700.0, 600.0]]);
    let drifting = RainArea {
        motion: AreaMotion::WithWind,
        kind: AreaRain::Drizzle,
        ..shower([-4000.0, 6000.0, 0.0], AreaShape::Ellipse([1500.0, 900.0]), 4.0)
    };
    context.set_rain_areas(&[
        shower([300.0, 1800.0, 0.0], AreaShape::Polygon(corners, 4), 30.0),
        shower([40.0, 260.0, 0.0], AreaShape::Ellipse([500.0, 280.0]), 12.0),
        drifting,
    ])
}

fn wind_grid(_: &Arc<Device>, context: &mut Context) -> Result<()> {
    let nodes = [6u32, 6, 4];
    let node = |i: u32| {
        let (x, y, z) = (i % 6, i / 6 % 6, i / 36);
        [3.0 + x as f32, -2.0 + 1.5 * y as f32, 0.4 * z as f32]
    };
    context.set_wind_grid(Some(WindGrid {
        origin: DVec3::new(-15.0, -5.0, 0.0),
        cell_m: DVec3::new(6.0, 6.0, 4.0),
        nodes,
        kind: WindGridKind::Added,
        velocities_m_s: (0..nodes.iter().product()).map(node).collect(),
    }))
}

fn storm(kind: PrecipitationKind, rate_mm_h: f64, wind_m_s: f64) -> Weather {
    let precipitation = Precipitation { showers: true, ..Precipitation::of(kind, rate_mm_h) };
    let clouds = vec![CloudLayer::of(CloudKind::Cumulonimbus, 0.8, 800.0)];
    Weather { precipitation, clouds, wind: Wind::of(wind_m_s, 250.0), visibility_m: 5000.0, ..Weather::default() }
}

fn falling() -> Result<Vec<Scene>> {
    let mut all = Vec::new();
    for model in [RainModel::Automatic, RainModel::Veil, RainModel::Cones, RainModel::Drops, RainModel::Integrated] {
        let rain = RainSettings { model, most_drops: Some(30_000), ..RainSettings::default() };
        for (light, (_, sun, moon)) in [("day", LIGHTS[0]), ("lamps", LIGHTS[3])] {
            let name = format!("rain-{model:?}-{light}").to_lowercase();
            let weather = storm(PrecipitationKind::Rain, 25.0, 8.0);
            let (dress, exposure) = if light == "lamps" { (lamps as Dress, LIT) } else { (wind_grid as Dress, None) };
            let scene = Scene { rain, sun, moon, dress, exposure, frames_before: 3, ..Scene::new(&name, weather) };
            all.push(Scene { velocity_m_s: DVec3::new(0.0, 6.0, 0.0), ..scene });
        }
    }
    let trainer = RainSettings { shutter_s: RainSettings::SHUTTER_EYE_S, ..RainSettings::TRAINER };
    all.push(Scene { rain: trainer, ..Scene::new("rain-trainer", storm(PrecipitationKind::Rain, 10.0, 5.0)) });
    for (name, kind, rate) in [
        ("hail", PrecipitationKind::Hail, 20.0),
        ("drizzle", PrecipitationKind::Drizzle, 1.0),
        ("snow", PrecipitationKind::Snow, 2.0),
    ] {
        let trainer = RainSettings::TRAINER;
        all.push(Scene {
            rain: trainer,
            dress: lamps,
            exposure: LIT,
            sun: [300.0, -30.0],
            ..Scene::new(&format!("falling-{name}-lamps"), storm(kind, rate, 6.0))
        });
    }
    let thunder =
        Scene { rain: RainSettings::TRAINER, ..Scene::preset("falling-thunderstorm-trainer", "thunderstorm")? };
    all.push(Scene { samples: [4, 4], name: "falling-thunderstorm-4".into(), ..thunder.clone() });
    all.push(thunder);
    let far = Scene {
        eye: DVec3::new(0.0, 0.0, 300.0),
        elevation: 0.0,
        dress: areas,
        ..Scene::preset("areas", "scattered")?
    };
    let near = Scene { eye: DVec3::new(0.0, 0.0, 2.2), name: "areas-below".into(), time_s: 30.0, ..far.clone() };
    let low = Scene { sun: [350.0, 5.0], name: "areas-low-sun".into(), ..far.clone() };
    let fast = Scene { name: "areas-no-compute".into(), tier_0: true, ..near.clone() };
    all.extend([far, near, low, fast]);
    Ok(all)
}

fn roofs(_: &Arc<Device>, context: &mut Context) -> Result<()> {
    context.set_shelters(&shelters())
}

/// Sets the yard's boxes as two maps: from above, and along a slant.
fn maps(device: &Arc<Device>, context: &mut Context) -> Result<()> {
    let size = (128, 128);
    let mut taken = Vec::new();
    for (eye, forward) in
        [(DVec3::new(0.0, 20.0, 40.0), DVec3::NEG_Z), (DVec3::new(-20.0, 20.0, 30.0), DVec3::new(0.5, 0.1, -0.85))]
    {
        let map = Taken::parallel(eye, forward, [30.0, 30.0], 80.0);
        let inverse: DMat4 = map.clip_from_world.inverse();
        let depth = |i: u32| {
            let ndc = DVec2::new(f64::from(i % size.0) + 0.5, f64::from(i / size.0) + 0.5) * 2.0 / 128.0 - 1.0;
            let from = inverse.project_point3(DVec3::new(ndc.x, -ndc.y, 1.0));
            let hit = World::Yard.cast(from, forward.normalize());
            hit.map_or(0.0, |h| map.clip_from_world.project_point3(h.at).z.clamp(0.0, 1.0)) as f32
        };
        let depths: Vec<f32> = (0..size.0 * size.1).map(depth).collect();
        taken.push((uploaded(device, size, wgpu::TextureFormat::R32Float, bytemuck::cast_slice(&depths)), map));
    }
    debug_assert!(taken.iter().all(|(_, m)| m.clip == ClipSpace::ZeroToOne));
    let maps: Vec<OccluderMap<'_>> = taken.iter().map(|(depth, taken)| OccluderMap { depth, taken: *taken }).collect();
    context.set_occluder_maps(&maps)
}

fn shelter() -> Result<Vec<Scene>> {
    let mut all = Vec::new();
    for (name, dress) in [("boxes", roofs as Dress), ("maps", maps)] {
        let scene =
            Scene { dress, rain: RainSettings::TRAINER, ..Scene::preset(&format!("shelter-{name}"), "heavy_rain")? };
        let below = Scene { eye: DVec3::new(-3.5, 8.0, 1.7), name: format!("shelter-{name}-below"), ..scene.clone() };
        let down = Scene {
            eye: DVec3::new(0.0, 2.0, 12.0),
            elevation: -35.0,
            name: format!("shelter-{name}-down"),
            ..scene.clone()
        };
        let multi = Scene { samples: [4, 4], name: format!("shelter-{name}-4"), ..scene.clone() };
        all.extend([scene, below, down, multi]);
    }
    Ok(all)
}

fn arm(time_s: f64) -> WiperArm {
    let position = 0.5 - 0.5 * (time_s * std::f64::consts::TAU / 1.6).cos();
    WiperArm {
        pivot_m: [0.3, -0.02],
        length_m: 0.45,
        inner_radius_m: 0.1,
        parked_deg: 10.0,
        far_deg: 165.0,
        position,
        ..WiperArm::default()
    }
}

fn quad(_: f64) -> Windscreen {
    let corner = |x: f64, y: f64| DVec3::new(0.55 * x, 0.3 * y, -0.6 + 0.1 * y);
    Windscreen {
        pane: Pane::Quad([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]),
        velocity_m_s: DVec3::new(0.0, 0.0, -12.0),
        airflow_m_s: 8.0,
        ..Windscreen::default()
    }
}

fn glass() -> Result<Vec<Scene>> {
    let wiped: fn(f64) -> Windscreen = |t| Windscreen { arms: [Some(arm(t)), None], ..quad(t) };
    let misted: fn(f64) -> Windscreen = |_| Windscreen { fogging: 0.6, demist: 0.4, ..Windscreen::default() };
    let mut all = Vec::new();
    for (name, screen) in [("drops", quad as fn(f64) -> Windscreen), ("wiped", wiped), ("misted", misted)] {
        let scene = Scene {
            windscreen: Some(screen),
            flags: FrameFlags(0),
            frames_before: 75,
            ..rain_by_day(&format!("glass-{name}"))?
        };
        let multi = Scene { samples: [1, 4], name: format!("glass-{name}-4"), ..scene.clone() };
        all.extend([scene, multi]);
    }
    let night =
        Scene { sun: [300.0, -30.0], dress: lamps, exposure: LIT, name: "glass-night".into(), ..all[2].clone() };
    let dry =
        Scene { dress: roofs, eye: DVec3::new(-3.5, 8.0, 1.7), name: "glass-below-roof".into(), ..all[0].clone() };
    let bytes = Scene { target: Target::SrgbBytes, name: "glass-srgb-bytes".into(), ..all[2].clone() };
    all.extend([night, dry, bytes]);
    Ok(all)
}

fn terrain(_: &Arc<Device>, context: &mut Context) -> Result<()> {
    context.set_ground_grid(Some(hill_grid()))
}

fn paved(_: &Arc<Device>, context: &mut Context) -> Result<()> {
    context.set_default_surface_class(SurfaceClass::Paved);
    Ok(())
}

fn ground() -> Result<Vec<Scene>> {
    let hills = |name: &str, preset: &str| -> Result<Scene> {
        let scene = Scene::preset(name, preset)?;
        Ok(Scene { world: World::Hills, eye: DVec3::new(0.0, -60.0, 75.0), elevation: -9.0, ..scene })
    };
    let simulated = |s: Scene| Scene { ground: GroundModel::Simulated, time_s: 5400.0, frames_before: 0, ..s };
    let mut soaked = Weather { wind: Wind::of(3.0, 240.0), ..Weather::default() };
    soaked.surface = Surface { state: Some(SurfaceState::StandingWater), ..Surface::default() };
    let low =
        Scene { weather: vec![(soaked.clone(), 0.0, 0.0)], sun: [10.0, 9.0], ..hills("ground-low-sun", "clear")? };
    let flat = Scene { dress: paved, sun: [10.0, 9.0], ..Scene::new("ground-paved-low-sun", soaked) };
    let lit = Scene {
        dress: lamps,
        exposure: LIT,
        sun: [300.0, -30.0],
        classes: true,
        ..Scene::preset("ground-lamps", "rain")?
    };
    let frozen = Scene { dress: paved, ..Scene::preset("ground-ice", "freezing_rain")? };
    let all = vec![
        hills("ground-hills", "rain")?,
        Scene { normals: Normals::World, classes: true, ..hills("ground-normals", "rain")? },
        Scene { normals: Normals::Eye, ..hills("ground-normals-eye", "rain")? },
        Scene { samples: [4, 4], classes: true, ..hills("ground-hills-4", "rain")? },
        simulated(Scene { dress: terrain, ..hills("ground-terrain", "heavy_rain")? }),
        simulated(Scene { dress: terrain, sun: [10.0, 9.0], ..hills("ground-terrain-low-sun", "showers")? }),
        simulated(Scene { dress: terrain, ..hills("ground-terrain-ice", "freezing_rain")? }),
        simulated(frozen.clone()),
        Scene { dress: terrain, name: "ground-terrain-reported".into(), ..hills("ground", "rain")? },
        Scene { name: "ground-ice-reported".into(), ..frozen },
        Scene { depth: Depth::Standard, ..hills("ground-standard-depth", "rain")? },
        low,
        flat,
        lit,
    ];
    Ok(all)
}

/// Scenes with several views, on devices without compute, and with pinned plans.
fn channels() -> Result<Vec<Scene>> {
    let mut all = vec![
        Scene { second_view: true, ..rain_by_day("two-views")? },
        Scene { second_view: true, dress: areas, ..Scene::preset("two-views-areas", "broken")? },
    ];
    for preset in ["clear", "fog", "shallow_fog", "rain", "thunderstorm"] {
        for (light, sun, moon) in &LIGHTS[..3] {
            let scene = Scene::preset(&format!("no-compute-{preset}-{light}"), preset)?;
            all.push(Scene { tier_0: true, classes: true, sun: *sun, moon: *moon, ..scene });
        }
    }
    let no_glass = Scene {
        tier_0: true,
        windscreen: Some(quad),
        flags: FrameFlags(0),
        frames_before: 40,
        ..rain_by_day("no-compute-glass")?
    };
    all.push(no_glass);
    all.push(Scene { tier_0: true, dress: maps, ..Scene::preset("no-compute-maps", "heavy_rain")? });
    for (name, rungs) in [
        ("all", [0; 4]),
        ("no-air", [1, 0, 0, 0]),
        ("no-fog", [0, 1, 0, 0]),
        ("no-sky", [0, 0, 1, 0]),
        ("cones", [0, 0, 0, 1]),
        ("no-rain", [0, 0, 0, 2]),
    ] {
        let scene = Scene { dress: areas, ..Scene::preset(&format!("pinned-{name}"), "mist")? };
        let wet = Scene { dress: areas, ..rain_by_day(&format!("pinned-{name}-rain"))? };
        all.extend([scene, wet].map(|s| Scene { pinned: Some(rungs), frames_before: 3, ..s }));
    }
    Ok(all)
}

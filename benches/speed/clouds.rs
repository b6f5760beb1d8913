//! Cost of clouds per frame on a software driver, in copies (see [`crate::copies`]) and relative to a clear sky's
//! frame. The camera looks 15 degrees up.

use std::sync::Arc;

use glam::DVec3;
use welkin::{
    clouds::{CloudModel, CloudSettings},
    context::{Context, GivenDirection},
    frame::{Frame, FrameFlags, Shared, Stages},
    gpu::{Device, DeviceOptions, readback},
    light::luminance,
    scene::HostLight,
    weather::{CloudKind, CloudLayer, Weather},
};
use welkin_support::{processor::processor_ns, textures::texture};

use crate::copies::{SIZE, Scene, measured, median, quantile, world};

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const PITCH_RAD: f64 = 0.26;
/// Rotation of a turning camera, rad per frame: 30 degrees per second at 60 Hz.
const TURN_RAD: f64 = 0.0087;

/// Creates a world with these cloud layers.
fn under(
    device: &Arc<Device>,
    shared: &Arc<Shared>,
    layers: &[CloudLayer],
    model: CloudModel,
) -> Fallible<Arc<Context>> {
    let weather = Weather { clouds: layers.to_vec(), ..Weather::default() };
    let mut context = world(device, shared, &weather, -60.0)?;
    Arc::get_mut(&mut context).ok_or("the world is shared already")?.set_cloud_model(model);
    Ok(context)
}

pub fn cumulus() -> [CloudLayer; 1] {
    [CloudLayer::of(CloudKind::Cumulus, 0.5, 1000.0)]
}

pub fn stratus() -> [CloudLayer; 1] {
    [CloudLayer::of(CloudKind::Stratus, 1.0, 600.0)]
}

pub fn three_layers() -> [CloudLayer; 3] {
    [
        CloudLayer::of(CloudKind::Cumulus, 0.35, 1000.0),
        CloudLayer::of(CloudKind::Altocumulus, 0.4, 4000.0),
        CloudLayer::of(CloudKind::Cirrus, 0.4, 9000.0),
    ]
}

/// Most steps of a ray through a layer at fineness 1 (`shaders/clouds/march.wgsl`).
const STEPS: f64 = 96.0;
/// Doubling the steps is not needed if the 95th percentile of the luminance difference is at most this.
const SAME: f64 = 0.01;
/// Finenesses to try; the last is the highest available.
const TRIED: [f64; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];

/// Finds the fineness for brute force: the lowest of [`TRIED`] at which the picture of broken cumulus, marched in every
/// pixel, stays the same with twice as many steps. If there is none, returns the highest.
fn brute_force() -> Fallible<f64> {
    let device = Device::headless(&DeviceOptions::default())?;
    let context = under(&device, &Arc::new(Shared::new(&device)?), &cumulus(), CloudModel::Volume)?;
    let mut scene = Scene::new("", &context, PITCH_RAD)?;
    let color = texture(&device, SIZE, wgpu::TextureFormat::Rgba16Float, 1);
    let mut picture = |fineness: f64| -> Fallible<Vec<f64>> {
        scene.view.set_clouds(CloudSettings { fineness, square_side: 1, ..Default::default() })?;
        scene.frame_id += 1;
        let frame = Frame::new(scene.frame_id, scene.camera, &color, None);
        let frame = Frame { flags: FrameFlags::NO_HISTORY, cd_m2_per_unit: 1e3, ..frame };
        scene.view.record(&context, &frame, Stages::BACKGROUND.with(Stages::MEDIUM))?;
        device.wait()?;
        Ok(readback::rgba(&device, &color)?.iter().map(|t| luminance(&[t[0], t[1], t[2]].map(f64::from))).collect())
    };
    let pictures = TRIED.into_iter().map(&mut picture).collect::<Fallible<Vec<_>>>()?;
    let off = |fewer: &[f64], more: &[f64]| {
        let white = more.iter().sum::<f64>() / more.len() as f64;
        let mut off: Vec<f64> = fewer.iter().zip(more).map(|(a, b)| (a - b).abs() / (b + 0.01 * white)).collect();
        quantile(&mut off, 0.95)
    };
    let mut enough = TRIED[TRIED.len() - 1];
    for i in (0..TRIED.len() - 1).rev() {
        let (twice, finest) = (off(&pictures[i], &pictures[i + 1]), off(&pictures[i], &pictures[TRIED.len() - 1]));
        println!(
            "broken cumulus, every pixel in at most {} steps: {:.2} % from twice as many, {:.2} % from {}",
            STEPS * TRIED[i],
            1e2 * twice,
            1e2 * finest,
            STEPS * TRIED[TRIED.len() - 1]
        );
        if twice <= SAME && enough == TRIED[i + 1] {
            enough = TRIED[i];
        }
    }
    Ok(enough)
}

/// Number of frames before a change of weather, by which the sky's tables have reached their final quality, and after
/// it. A frame is a twentieth of a second; the change takes [`COMES_S`].
const FRAMES: [u64; 2] = [160, 120];
const COMES_S: f64 = 3.0;

/// Prints the frame times while fair cumulus changes to stratocumulus under cirrus, relative to the median afterwards.
fn changed() -> Fallible<()> {
    let device = Device::headless(&DeviceOptions::default())?;
    let mut context = under(&device, &Arc::new(Shared::new(&device)?), &cumulus(), CloudModel::Volume)?;
    let mut scene = Scene::new("", &context.clone(), PITCH_RAD)?;
    // Drops the scene's reference to the context, because a shared context cannot be changed.
    scene.context = under(&device, &Arc::new(Shared::new(&device)?), &[], CloudModel::Volume)?;
    let (color, mut times) = (texture(&device, SIZE, wgpu::TextureFormat::Rgba16Float, 1), Vec::new());
    for id in 1..=FRAMES[0] + FRAMES[1] {
        let time_s = id as f64 / 20.0;
        let before = processor_ns();
        let changing = Arc::get_mut(&mut context).ok_or("the world is shared already")?;
        if id == FRAMES[0] {
            let clouds = [(CloudKind::Stratocumulus, 0.8, 900.0), (CloudKind::Cirrus, 0.5, 9000.0)];
            let clouds = clouds.map(|(kind, cover, base_m)| CloudLayer::of(kind, cover, base_m)).to_vec();
            changing.set_weather(&Weather { clouds, ..Weather::default() }, time_s, COMES_S)?;
        }
        changing.update(time_s)?;
        let frame = Frame::new(id, scene.camera, &color, None);
        scene.view.record(&context, &frame, Stages::BACKGROUND.with(Stages::MEDIUM))?;
        device.wait()?;
        if id >= FRAMES[0] {
            times.push((processor_ns() - before) as f64);
        }
    }
    let settled = median(&mut times[(COMES_S * 20.0) as usize + 1..].to_vec());
    let coming = &mut times[..(COMES_S * 20.0) as usize + 1];
    let first = coming[0];
    let (middle, most) = (median(coming), coming[coming.len() - 1]);
    println!(
        "a change of weather: its first frame takes {:.2} times the median after it, the slowest while it comes {:.2}, the median of those {:.2}",
        first / settled,
        most / settled,
        middle / settled
    );
    Ok(())
}

/// Creates a night with these clouds, lit by a number of lamps on the ground.
fn at_night(device: &Arc<Device>, shared: &Arc<Shared>, layers: &[CloudLayer], lamps: usize) -> Fallible<Arc<Context>> {
    let mut context = under(device, shared, layers, CloudModel::Volume)?;
    let changing = Arc::get_mut(&mut context).ok_or("the world is shared already")?;
    changing.set_sun(Some(GivenDirection { azimuth_deg: 180.0, elevation_deg: -40.0 }))?;
    let lamp = |i: usize| HostLight {
        position_m: DVec3::new(300.0 * i as f64, 2000.0, 5.0),
        direction: DVec3::Z,
        intensity_cd: [1e7; 3],
        inner_deg: 60.0,
        outer_deg: 80.0,
    };
    changing.set_lights(&(0..lamps).map(lamp).collect::<Vec<_>>())?;
    changing.update(0.0)?;
    Ok(context)
}

/// Name of the brute-force scene.
const BRUTE: &str = "broken cumulus, every pixel in as many steps as it takes";

fn scenes(device: &Arc<Device>, fineness: f64) -> Fallible<Vec<Scene>> {
    let shared = Arc::new(Shared::new(device)?);
    let (broken, closed, several) = (cumulus(), stratus(), three_layers());
    let volume = |layers: &[CloudLayer]| under(device, &shared, layers, CloudModel::Volume);
    let (clear, deck) = (volume(&[])?, under(device, &shared, &closed, CloudModel::Deck)?);
    let (broken, closed, several) = (volume(&broken)?, volume(&closed)?, volume(&several)?);
    let night = [0, 1, 4].map(|lamps| at_night(device, &shared, &cumulus(), lamps));
    let scene = |name, context| Scene::new(name, context, PITCH_RAD);
    let mut brute = scene(BRUTE, &broken)?;
    brute.flags = FrameFlags::NO_HISTORY;
    brute.view.set_clouds(CloudSettings { fineness, square_side: 1, ..Default::default() })?;
    let mut shafts = scene("broken cumulus, at rest, with shafts of light", &broken)?;
    shafts.view.set_clouds(CloudSettings { shafts: true, ..Default::default() })?;
    let [dark, one, four] = night;
    Ok(vec![
        scene("clear sky", &clear)?,
        scene("closed deck, Deck", &deck)?,
        scene("closed deck, Volume", &closed)?,
        scene("broken cumulus, at rest", &broken)?,
        shafts,
        Scene { turn_rad: TURN_RAD, ..scene("broken cumulus, turning", &broken)? },
        scene("three layers, at rest", &several)?,
        Scene { flags: FrameFlags::NO_HISTORY, ..scene("broken cumulus, every pixel", &broken)? },
        brute,
        scene("broken cumulus at night", &dark?)?,
        scene("broken cumulus at night, over a lamp", &one?)?,
        scene("broken cumulus at night, over four lamps", &four?)?,
    ])
}

/// Prints the cost of each sky.
pub fn run() -> Fallible<()> {
    let fineness = brute_force()?;
    changed()?;
    let mut scenes = measured(PITCH_RAD, |device| scenes(device, fineness))?;
    let (clear, bytes) = (median(&mut scenes[0].copies), scenes[0].view.report().bytes);
    let mut turning = f64::NAN;
    for mut scene in scenes {
        let copies = median(&mut scene.copies);
        let more = scene.view.report().bytes as i64 - bytes as i64;
        println!("  {}: {copies:.1} copies, {:.2} of a clear sky, {more} bytes more", scene.name, copies / clear);
        if scene.turn_rad != 0.0 {
            turning = copies;
        } else if scene.name == BRUTE {
            println!(
                "  the default, turning, takes 1/{:.1} of every pixel in {} steps",
                copies / turning,
                STEPS * fineness
            );
        }
    }
    Ok(())
}

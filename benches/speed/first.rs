//! The first picture of a new process with empty caches, and the frames during a change of weather: how long a host
//! waits, when the picture reaches its final quality, and how long the slowest frame takes relative to the median of
//! the frames after it.
//!
//! Each scene runs in a process of its own, with the drivers' caches empty in memory and on disk.

use std::{process::Command, sync::Arc, time::Instant};

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{ColorSpace, Frame, FrameFlags, Shared, Stages, View, tone::srgb_encode},
    gpu::{Device, DeviceOptions, readback},
    scene::Camera,
    weather::Weather,
};
use welkin_support::textures;

type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: wgpu::Extent3d = wgpu::Extent3d { width: 640, height: 360, depth_or_array_layers: 1 };
const FRAMES: u64 = 250;

/// The first weather of a scene, and the weather it changes to.
struct Script {
    name: &'static str,
    first: &'static str,
    /// The report set at frame `CHANGE`, and the duration of the change, s.
    then: Option<(&'static str, f64)>,
}

const SCRIPTS: [Script; 4] = [
    Script { name: "clear", first: "LOWI 121150Z 24008KT 9999 FEW040 18/09 Q1015", then: None },
    Script { name: "rain", first: "LOWI 121150Z 24008KT 4000 +RA BKN020 12/11 Q1005", then: None },
    Script {
        name: "new report",
        first: "LOWI 121150Z 24008KT 9999 FEW040 18/09 Q1015",
        then: Some(("LOWI 121220Z 24008KT 5000 RA BKN020 12/11 Q1005", 0.0)),
    },
    Script {
        name: "changing",
        first: "LOWI 121150Z 24008KT 9999 FEW040 18/09 Q1015",
        then: Some(("LOWI 121220Z 24008KT 2000 BR OVC010 12/11 Q1005", 3.0)),
    },
];
/// Frame at which the weather changes.
const CHANGE: u64 = 125;

fn texture(device: &Device, format: wgpu::TextureFormat) -> wgpu::Texture {
    textures::texture(device, (SIZE.width, SIZE.height), format, 1)
}

/// Runs one scene in this process.
fn script(script: &Script) -> Fallible<()> {
    let detailed = std::env::var_os("FIRST_FRAMES").is_some();
    let start = Instant::now();
    let step = |what: &str| {
        if detailed {
            println!("    {what}: {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
        }
    };
    let backends = match std::env::var("FIRST_BACKEND").as_deref() {
        Ok("gl") => wgpu::Backends::GL,
        _ => DeviceOptions::default().backends,
    };
    let device = Device::headless(&DeviceOptions { backends, ..DeviceOptions::default() })?;
    step("device");
    let shared = Arc::new(Shared::new(&device)?);
    step("shared");
    let mut context = Context::new(device.clone(), shared, ContextDesc::default())?;
    step("context");
    context.set_sun(Some(GivenDirection { azimuth_deg: 60.0, elevation_deg: 35.0 }))?;
    context.set_weather(&Weather::from_metar(script.first)?.weather, 0.0, 0.0)?;
    let mut view = View::new(&context)?;
    step("view");
    // Floats, so that dither does not look like a change.
    let (color, depth) =
        (texture(&device, wgpu::TextureFormat::Rgba16Float), texture(&device, wgpu::TextureFormat::R32Float));
    let row = |y: u32| if y >= 180 { 0.1 / (30.0 * 180.0 / (y as f32 - 179.0)) } else { 0.0 };
    let texels: Vec<f32> = (0..SIZE.width * SIZE.height).map(|i| row(i / SIZE.width)).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE.width * 4), rows_per_image: None };
    device.queue.write_texture(depth.as_image_copy(), bytemuck::cast_slice(&texels), layout, SIZE);
    let grey = vec![0x2cu8; (SIZE.width * SIZE.height * 8) as usize];
    let rows = wgpu::TexelCopyBufferLayout { bytes_per_row: Some(SIZE.width * 8), ..layout };
    let camera = Camera::look_to(DVec3::new(0.0, 0.0, 10.0), DVec3::Y, DVec3::Z, 0.9, 16.0 / 9.0, 0.1);
    let (mut times, mut pictures, mut ends) = (Vec::new(), Vec::new(), Vec::new());
    let mut aside = 0.0;
    for id in 0..if script.then.is_some() { FRAMES } else { CHANGE } {
        // The host's own work is not counted.
        let before = Instant::now();
        device.queue.write_texture(color.as_image_copy(), &grey, rows, SIZE);
        device.wait()?;
        aside += if id == 0 { 0.0 } else { before.elapsed().as_secs_f64() };
        let began = Instant::now();
        let time_s = id as f64 / 20.0;
        if let (CHANGE, Some((report, over_s))) = (id, script.then) {
            context.set_weather(&Weather::from_metar(report)?.weather, time_s, over_s)?;
        }
        context.update(time_s)?;
        let mut frame = Frame::new(id, camera, &color, Some(&depth));
        frame.color_space = ColorSpace::DisplayLinear;
        if std::env::var_os("FIRST_PURE").is_some() {
            frame.flags = FrameFlags::NO_HISTORY;
        }
        view.record(&context, &frame, Stages::ALL.without(Stages::TONE))?;
        let recorded = began.elapsed();
        device.wait()?;
        times.push(began.elapsed().as_secs_f64() * 1e3);
        ends.push(start.elapsed().as_secs_f64() - aside);
        if detailed {
            println!(
                "    frame {id}: {:.1} ms, {:.1} of them to record",
                times[id as usize],
                recorded.as_secs_f64() * 1e3
            );
        }
        let before = Instant::now();
        pictures.push(readback::rgba(&device, &color)?.iter().flat_map(encoded).collect());
        aside += before.elapsed().as_secs_f64();
    }
    report(script, &device, &times, &ends, &pictures);
    Ok(())
}

fn median(times: &[f64]) -> f64 {
    let mut sorted = times.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

/// Number of parts into which a step of 1/255 is divided.
const PARTS: f64 = 200.0;

/// A pixel's channels as a display gets them, in those parts.
fn encoded(pixel: &[f32; 4]) -> [u16; 3] {
    [0, 1, 2].map(|c| (PARTS * 255.0 * srgb_encode(f64::from(pixel[c].clamp(0.0, 1.0)))).round() as u16)
}

/// Largest difference between two pictures, in 255ths.
fn apart(a: &[u16], b: &[u16]) -> f64 {
    a.iter().zip(b).map(|(x, y)| f64::from(x.abs_diff(*y)) / PARTS).fold(0.0, f64::max)
}

fn report(script: &Script, device: &Device, times: &[f64], ends: &[f64], pictures: &[Vec<u16>]) {
    let end = script.then.map_or(times.len(), |_| CHANGE as usize);
    let slowest = |times: &[f64]| (0..times.len() - 8).map(|i| times[i] / median(&times[i + 1..])).fold(0.0, f64::max);
    let worst = |p: &[Vec<u16>]| p.windows(2).map(|w| apart(&w[0], &w[1])).fold(0.0, f64::max);
    println!("{}, {}:", script.name, device.caps().adapter_name);
    let last = &pictures[end - 1];
    let settled = pictures[..end].iter().rposition(|p| apart(p, last) > 1.0).map_or(0, |i| i + 1);
    println!(
        "  first picture after {:.2} s, within 1 of 255 of the last one from frame {settled} on, after {:.2} s; the first \
         frame {:.0} ms, those after it {:.1} ms in the median, {:.2} times that at most; a frame's step at most {:.1} of \
         255, the first picture {:.1} from the last",
        ends[0],
        ends[settled],
        times[0],
        median(&times[1..end]),
        slowest(&times[1..end]),
        worst(&pictures[..end]),
        apart(&pictures[0], last)
    );
    if script.then.is_some() {
        let after = &times[CHANGE as usize..];
        println!(
            "  after the change {:.1} ms in the median, the slowest {:.0} ms, {:.2} times the median; a frame's step at most \
             {:.1} of 255",
            median(after),
            after.iter().copied().fold(0.0, f64::max),
            after.iter().copied().fold(0.0, f64::max) / median(after),
            worst(&pictures[CHANGE as usize - 1..])
        );
    }
}

pub fn run() -> Fallible<()> {
    if let Ok(name) = std::env::var("FIRST_SCRIPT") {
        return SCRIPTS.iter().find(|s| s.name == name).map_or(Ok(()), script);
    }
    println!("first picture at {} x {}, in a new process without caches:", SIZE.width, SIZE.height);
    let empty = std::env::temp_dir().join(format!("welkin-first-{}", std::process::id()));
    for script in &SCRIPTS {
        let mut child = Command::new(std::env::current_exe()?);
        child.args(["first"]).env("FIRST_SCRIPT", script.name).env("XDG_CACHE_HOME", &empty);
        child.env("MESA_SHADER_CACHE_DISABLE", "true").env("MESA_SHADER_CACHE_DIR", &empty);
        child.env("__GL_SHADER_DISK_CACHE", "0");
        if !child.status()?.success() {
            return Err(format!("the process for {} failed", script.name).into());
        }
    }
    if empty.exists() {
        std::fs::remove_dir_all(&empty)?;
    }
    Ok(())
}

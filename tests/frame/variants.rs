//! A view whose formats, models and lamps change all the time: memory for compiled variants is released.

use glam::{DMat3, DVec3};
use welkin::{
    fog::{
        Law,
        laws::{CompatibilityLaw, Curve, DistanceKind},
    },
    frame::{ColorSpace, Exposure, Frame, Stages},
    rain::{Planes, RainModel, RainSettings, Shelter},
    scene::HostLight,
    weather::{Fog, FogKind, Precipitation, PrecipitationKind, Weather},
};
use welkin_support::{
    accept,
    frame_host::{Host, camera, texture},
};

/// Set in the process of its own in which memory is measured.
const ALONE: &str = "WELKIN_ALONE";

/// Memory of this process, MB.
fn resident_mb() -> f64 {
    let text = std::fs::read_to_string("/proc/self/statm").expect("Linux says how much memory a process has");
    let pages: f64 = text.split(' ').nth(1).unwrap().parse().unwrap();
    pages * 4096.0 * 1e-6
}

const FORMATS: [wgpu::TextureFormat; 5] = {
    use wgpu::TextureFormat as F;
    [F::Rgba16Float, F::Rgba8Unorm, F::Bgra8Unorm, F::Rgba8UnormSrgb, F::Rgb10a2Unorm]
};

/// Draws frame `id` of a sequence of which hardly two have the same pipelines.
fn record(host: &mut Host, colors: &[wgpu::Texture], id: u64, variant: usize) {
    let bit = |n: usize| variant >> n & 1 == 1;
    let lamp = HostLight {
        position_m: camera().position,
        direction: DVec3::Y,
        intensity_cd: [1e4; 3],
        inner_deg: 10.0,
        outer_deg: 30.0,
    };
    let roof = Shelter {
        center_m: camera().position + DVec3::Z * 3.0,
        axes: DMat3::IDENTITY,
        half_size_m: DVec3::ONE,
        velocity_m_s: DVec3::ZERO,
        planes: Planes::NONE,
    };
    let law = CompatibilityLaw {
        curve: Curve::Exponential { density_per_m: 1e-3 },
        distance: DistanceKind::Range,
        colour: None,
        sky_band: 0.2,
    };
    host.context.set_lights(&[lamp][..usize::from(bit(0))]).unwrap();
    host.context.set_shelters(&[roof][..usize::from(bit(1))]).unwrap();
    host.context.set_fog_law(bit(2).then_some(Law::Compatibility(law))).unwrap();
    let model = if bit(3) { RainModel::Cones } else { RainModel::Veil };
    host.view.set_rain(RainSettings { model, ..RainSettings::default() }).unwrap();
    let color = &colors[variant % FORMATS.len()];
    let display = color.format() != wgpu::TextureFormat::Rgba16Float;
    let mut stages = Stages::PREPARE.0 | Stages::MEDIUM.0 | Stages::PARTICLES.0;
    if bit(4) {
        stages |= Stages::BACKGROUND.0;
    }
    if bit(5) {
        stages |= Stages::SURFACE.0;
    }
    let frame = Frame {
        color_space: if display { ColorSpace::DisplayLinear } else { ColorSpace::SceneLinear },
        exposure: Some(Exposure::Ev100(13.0)),
        ..Frame::new(id, camera(), color, bit(6).then_some(&host.depth))
    };
    host.view.record(&host.context, &frame, Stages(stages)).unwrap();
    host.device.wait().unwrap();
}

/// With `WELKIN_ACCEPT` there are more variants than the cache holds, so that in the second round each is compiled anew
/// and replaces another.
#[test]
fn memory_levels_off_however_formats_models_and_lamps_change() {
    if std::env::var_os(ALONE).is_none() {
        let name = "variants::memory_levels_off_however_formats_models_and_lamps_change";
        let mut alone = std::process::Command::new(std::env::current_exe().unwrap());
        let outcome = alone.args(["--exact", name, "--nocapture"]).env(ALONE, "1").status().unwrap();
        assert!(outcome.success());
        return;
    }
    let count = if accept() { 60 } else { 6 };
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    let colors = FORMATS.map(|format| texture(&host.device, format, 1));
    let mist = Weather {
        visibility_m: 3000.0,
        fog: Fog::of(FogKind::Mist),
        precipitation: Precipitation::of(PrecipitationKind::Rain, 8.0),
        ..Weather::default()
    };
    host.context.set_weather(&mist, 0.0, 0.0).unwrap();
    let mut held = vec![resident_mb()];
    for round in 0..2 {
        for i in 0..count {
            // Through all bits, in an order that changes many at once.
            record(&mut host, &colors, (round * count + i) as u64, i * 37 % 640);
            if (i + 1) % (count / 2) == 0 {
                held.push(resident_mb());
            }
        }
    }
    println!("resident, MB, from half a round to the next of {count} variants: {held:.0?}");
    let (first, second) = (held[2] - held[0], held[4] - held[2]);
    assert!(second < 0.15 * first.max(200.0), "the second round adds {second:.0} MB to the {first:.0} of the first");
}

//! Pictures for people to look at: WELKIN_GLASS_PICTURES=<folder> writes them; without it a few are drawn and checked.

use glam::DVec3;
use half::f16;
use welkin::{
    frame::{Exposure, Frame, FrameFlags, Stages},
    glass::{Pane, Windscreen, WiperArm},
};

use crate::host::{Host, camera};

const SIZE: (u32, u32) = (640, 360);

/// Linear radiance of a street: sky, trees, road, cars; at night its lamps.
fn street(x: f64, y: f64, night: bool) -> [f64; 3] {
    let horizon = 0.46;
    let trees = horizon - 0.06 - 0.05 * (9.0 * x).sin() - 0.03 * (31.0 * x + 1.0).sin() - 0.02 * (77.0 * x).sin();
    let mut c = if y < trees {
        [0.55, 0.62, 0.7].map(|v| v * (0.7 + 0.6 * y))
    } else if y < horizon {
        [0.05, 0.08, 0.04]
    } else {
        let depth = (y - horizon) / (1.0 - horizon);
        let across = (x - 0.5) / (0.04 + 0.9 * depth);
        let line = across.abs() < 0.025 && (4.0 / (depth + 0.05)).fract() < 0.5;
        match across.abs() {
            _ if line => [0.8, 0.8, 0.75],
            a if a < 0.55 => [0.16, 0.16, 0.17],
            a if a < 0.6 => [0.7, 0.7, 0.65],
            _ => [0.14, 0.22, 0.07],
        }
    };
    for (cx, cy, w, h, body) in
        [(0.56, 0.50, 0.05, 0.07, [0.6, 0.05, 0.04]), (0.30, 0.52, 0.07, 0.09, [0.1, 0.15, 0.5])]
    {
        if f64::abs(x - cx) < w && f64::abs(y - cy) < h / 2.0 {
            c = body;
        }
    }
    if night {
        c = c.map(|v| v * 0.02);
        let lamp = |cx: f64, cy: f64, r: f64| ((x - cx) * 16.0 / 9.0).hypot(y - cy) < r;
        for (cx, cy, r, light) in [
            (0.27, 0.53, 0.012, [40.0, 38.0, 30.0]),
            (0.33, 0.53, 0.012, [40.0, 38.0, 30.0]),
            (0.53, 0.50, 0.008, [14.0, 0.8, 0.5]),
            (0.59, 0.50, 0.008, [14.0, 0.8, 0.5]),
            (0.15, 0.20, 0.016, [30.0, 20.0, 8.0]),
            (0.72, 0.30, 0.010, [30.0, 20.0, 8.0]),
            (0.63, 0.37, 0.007, [30.0, 20.0, 8.0]),
            (0.90, 0.15, 0.018, [30.0, 20.0, 8.0]),
            (0.47, 0.40, 0.007, [2.0, 18.0, 9.0]),
        ] {
            if lamp(cx, cy, r) {
                c = light;
            }
        }
    }
    c
}

struct WindscreenScene {
    name: &'static str,
    rate_mm_h: f64,
    speed_m_s: f64,
    airflow_m_s: f64,
    wipers: bool,
    night: bool,
    fogging: f64,
    demist: f64,
    seconds: f64,
    /// Distance to the glass, m.
    near_m: f64,
}

const SCENE: WindscreenScene = WindscreenScene {
    name: "",
    rate_mm_h: 6.0,
    speed_m_s: 0.0,
    airflow_m_s: 0.0,
    wipers: false,
    night: false,
    fogging: 0.0,
    demist: 0.0,
    seconds: 20.0,
    near_m: 0.4,
};

fn scenes() -> Vec<WindscreenScene> {
    vec![
        WindscreenScene { name: "steady", speed_m_s: 8.0, ..SCENE },
        WindscreenScene { name: "steady_wiped", speed_m_s: 8.0, wipers: true, ..SCENE },
        WindscreenScene { name: "declared", speed_m_s: 8.0, seconds: 0.0, ..SCENE },
        WindscreenScene { name: "cloudburst", rate_mm_h: 120.0, speed_m_s: 10.0, ..SCENE },
        WindscreenScene { name: "cloudburst_wiped", rate_mm_h: 120.0, speed_m_s: 10.0, wipers: true, ..SCENE },
        WindscreenScene { name: "night", speed_m_s: 8.0, night: true, ..SCENE },
        WindscreenScene { name: "night_wiped", speed_m_s: 8.0, night: true, wipers: true, ..SCENE },
        WindscreenScene { name: "fast", speed_m_s: 28.0, airflow_m_s: 22.0, ..SCENE },
        WindscreenScene { name: "drizzle", rate_mm_h: 0.4, speed_m_s: 8.0, ..SCENE },
        WindscreenScene {
            name: "misted",
            fogging: 0.8,
            demist: 0.5,
            seconds: 2.0,
            rate_mm_h: 2.0,
            speed_m_s: 5.0,
            ..SCENE
        },
        WindscreenScene { name: "close", speed_m_s: 8.0, near_m: 0.15, ..SCENE },
    ]
}

fn screen(shot: &WindscreenScene, time_s: f64) -> Windscreen {
    // Glass that leans back by 30 degrees, as wide as the picture and more.
    let (n, aspect) = (shot.near_m, 16.0 / 9.0);
    let (half, lean) = (0.42 * n * 1.15, 0.5);
    let corner = |x: f64, y: f64| DVec3::new(x * half * aspect, y * half, -n + lean * y * half);
    let stroke = (time_s * std::f64::consts::TAU / 1.6).cos();
    let arm = WiperArm {
        pivot_m: [half * aspect * 0.9, -0.02],
        length_m: half * 2.6,
        inner_radius_m: half * 0.5,
        parked_deg: 10.0,
        far_deg: 165.0,
        position: 0.5 - 0.5 * stroke,
        ..WiperArm::default()
    };
    Windscreen {
        pane: Pane::Quad([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]),
        velocity_m_s: DVec3::new(0.0, 0.0, -shot.speed_m_s),
        airflow_m_s: shot.airflow_m_s,
        fogging: shot.fogging,
        demist: shot.demist,
        arms: [shot.wipers.then_some(arm), None],
        ..Windscreen::default()
    }
}

fn paint(host: &Host, night: bool) {
    let texel = |i: u32| {
        let (x, y) = (f64::from(i % SIZE.0) + 0.5, f64::from(i / SIZE.0) + 0.5);
        let [r, g, b] = street(x / f64::from(SIZE.0), y / f64::from(SIZE.1), night);
        [r, g, b, 1.0].map(|v| f16::from_f64(v).to_bits())
    };
    let texels: Vec<u16> = (0..SIZE.0 * SIZE.1).flat_map(texel).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * SIZE.0), rows_per_image: None };
    let bytes: Vec<u8> = texels.iter().flat_map(|t| t.to_le_bytes()).collect();
    host.device.queue.write_texture(host.color.as_image_copy(), &bytes, layout, host.color.size());
}

fn draw(shot: &WindscreenScene) -> Vec<[f32; 4]> {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float, SIZE, shot.rate_mm_h);
    let frames = (shot.seconds * 20.0) as u32;
    for i in 0..=frames {
        let time_s = 100.0 + f64::from(i) / 20.0;
        host.view.set_windscreen(Some(&screen(shot, time_s))).unwrap();
        if i < frames {
            host.at(time_s, Stages::PREPARE, FrameFlags(0)).unwrap();
            continue;
        }
        paint(&host, shot.night);
        host.context.update(time_s).unwrap();
        let mut frame = Frame::new(9999, camera(), &host.color, None);
        frame.exposure = Some(Exposure::Factor(1.3));
        host.view.record(&host.context, &frame, Stages::PREPARE.with(Stages::LENS).with(Stages::TONE)).unwrap();
    }
    let report = host.view.windscreen_report().unwrap().unwrap();
    println!("{}: {report:?}", shot.name);
    host.pixels()
}

fn save(pixels: &[[f32; 4]], path: &std::path::Path) {
    let encode = |v: f32| {
        let v = f64::from(v).clamp(0.0, 1.0);
        let e = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
        (255.0 * e).round() as u8
    };
    let bytes: Vec<u8> = pixels.iter().flat_map(|p| [encode(p[0]), encode(p[1]), encode(p[2])]).collect();
    image::save_buffer(path, &bytes, SIZE.0, SIZE.1, image::ColorType::Rgb8).unwrap();
}

#[test]
fn pictures_are_finite_and_not_negative() {
    let folder = std::env::var("WELKIN_GLASS_PICTURES").ok();
    let only = std::env::var("WELKIN_GLASS_ONLY").unwrap_or_default();
    for shot in scenes() {
        if folder.is_none() && shot.seconds > 3.0 || !shot.name.contains(&only) {
            continue;
        }
        let pixels = draw(&shot);
        assert!(pixels.iter().flatten().all(|v| v.is_finite() && *v >= 0.0), "{}", shot.name);
        if let Some(folder) = &folder {
            save(&pixels, &std::path::Path::new(folder).join(format!("{}.png", shot.name)));
        }
    }
}

//! The first frames: a draft of the sky, refined without a visible step into the picture that a frame without history
//! has at once.

use glam::DVec3;
use welkin::{
    context::{Context, ContextDesc, GivenDirection},
    frame::{ColorSpace, Exposure, Frame, FrameFlags, Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    scene::Camera,
    weather::{Aerosol, AerosolKind, Weather},
};
use welkin_support::frame_host::texture;

/// Frames in which the tables of a draft become whole: slices of 1/80 in seven of eight frames, a frame in which
/// observers draw them, and a fade of sixteen, with a few to spare for slices that do not come out even.
const FRAMES: u64 = 120;

struct Host {
    device: std::sync::Arc<Device>,
    context: Context,
    views: Vec<View>,
    color: wgpu::Texture,
    id: u64,
}

impl Host {
    /// Creates the views with the default sky.
    fn new(views: usize) -> Self {
        let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
        let shared = std::sync::Arc::new(Shared::new(&device).unwrap());
        let mut context = Context::new(device.clone(), shared, ContextDesc::default()).unwrap();
        context.set_sun(Some(GivenDirection { azimuth_deg: 140.0, elevation_deg: 20.0 })).unwrap();
        let views = (0..views).map(|_| View::new(&context).unwrap()).collect();
        let color = texture(&device, wgpu::TextureFormat::Rgba16Float, 1);
        Self { device, context, views, color, id: 0 }
    }

    /// The next frame on every view, in 255ths of the display's range; and the work on tables that it reports.
    fn frame(&mut self, flags: FrameFlags) -> Vec<Vec<f32>> {
        self.id += 1;
        let camera = Camera::look_to(DVec3::new(0.0, 0.0, 5.0), DVec3::new(0.5, 1.0, 0.3), DVec3::Z, 1.2, 1.78, 0.1);
        let mut pictures = Vec::new();
        for view in &mut self.views {
            let mut frame = Frame::new(self.id, camera, &self.color, None);
            frame.color_space = ColorSpace::DisplayLinear;
            frame.exposure = Some(Exposure::Factor(6e-5));
            frame.flags = flags;
            view.record(&self.context, &frame, Stages::PREPARE.with(Stages::BACKGROUND)).unwrap();
            let pixels = readback::rgba(&self.device, &self.color).unwrap();
            let encode = |v: f32| 255.0 * welkin::frame::tone::srgb_encode(f64::from(v.clamp(0.0, 1.0))) as f32;
            pictures.push(pixels.iter().flat_map(|p| [p[0], p[1], p[2]]).map(encode).collect());
        }
        pictures
    }
}

fn apart(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f32::max)
}

#[test]
fn a_draft_is_refined_without_a_visible_step_into_what_a_frame_without_history_shows() {
    let mut host = Host::new(2);
    let mut frames: Vec<Vec<f32>> = Vec::new();
    let mut worked = 0;
    for i in 0..FRAMES {
        let [a, b] = host.frame(FrameFlags(0)).try_into().unwrap();
        assert_eq!(a, b, "views of one context agree while they refine: frame {i}");
        worked += u32::from(host.views[0].report().tables_rebuilt > 0);
        frames.push(a);
    }
    let last = frames.last().unwrap();
    assert!(frames.iter().all(|f| f.iter().any(|v| *v > 40.0)), "there is a sky in the first frame too");
    let step = frames.windows(2).map(|w| apart(&w[0], &w[1])).fold(0.0, f32::max);
    let draft = apart(&frames[0], last);
    println!("draft {draft:.2} of 255 from the whole, largest step {step:.2}, work in {worked} of {FRAMES} frames");
    assert!(draft > 0.02 && draft <= 3.0, "a draft is no whole, and near it: {draft}");
    assert!(step <= 1.0, "no step that an eight-bit display would show: {step}");
    let [pure, _] = host.frame(FrameFlags::NO_HISTORY).try_into().unwrap();
    assert_eq!(*last, pure, "it arrives, to the bit, in {FRAMES} frames");
    let [still, _] = host.frame(FrameFlags(0)).try_into().unwrap();
    assert_eq!((&still, host.views[0].report().tables_rebuilt), (&pure, 0), "and stays");
    // A first frame without history, and tables that are built ahead, are whole.
    let mut at_once = Host::new(1);
    assert_eq!(at_once.frame(FrameFlags::NO_HISTORY)[0], pure);
    let mut ahead = Host::new(1);
    ahead.context.build_sky(&mut |_| true).unwrap();
    assert_eq!(ahead.frame(FrameFlags(0))[0], pure);
}

#[test]
fn the_same_frames_refine_alike_on_two_channels() {
    let run = || {
        let mut host = Host::new(1);
        let mut pictures: Vec<_> = (0..4).map(|_| host.frame(FrameFlags(0)).remove(0)).collect();
        // The air changes before its first tables are whole. They are given up for a draft of the new air, which fades
        // in.
        let haze = Weather { visibility_m: 6000.0, aerosol: Aerosol::of(AerosolKind::Haze), ..Weather::default() };
        host.context.set_weather(&haze, 0.0, 0.0).unwrap();
        pictures.extend((0..28).map(|_| host.frame(FrameFlags(0)).remove(0)));
        let pure = host.frame(FrameFlags::NO_HISTORY).remove(0);
        (pictures, pure)
    };
    let ((a, pure), (b, _)) = (run(), run());
    assert_eq!(a, b, "bit for bit");
    let whole = apart(&a[3], &pure);
    assert!(whole > 10.0, "haze shows: {whole}");
    let last = apart(&a[31], &pure);
    let step = a.windows(2).map(|w| apart(&w[0], &w[1])).fold(0.0, f32::max);
    println!(
        "haze changes the picture by {whole:.1} of 255, by {step:.2} in a frame; 28 frames later {last:.2} are left"
    );
    assert!(step <= whole / 10.0, "{step}");
    assert!(last <= 0.2 * whole, "a draft of the new air has faded in within 28 frames: {last}");
}

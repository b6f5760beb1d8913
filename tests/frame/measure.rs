//! Costs of the effects of a frame: measured on request, together about the whole, and absent otherwise.

use std::time::Instant;

use welkin::{
    Status,
    frame::{ColorSpace, CostItem, Costs, Exposure, Frame, FrameFlags, Stages},
};
use welkin_support::frame_host::{Host, camera};

fn record(host: &mut Host, frame_id: u64, flags: FrameFlags, stages: Stages) {
    let mut frame = Frame::new(frame_id, camera(), &host.color, Some(&host.depth));
    frame.exposure = Some(Exposure::Factor(2e-4));
    frame.flags = flags;
    host.view.record(&host.context, &frame, stages).unwrap();
}

fn measured(host: &mut Host, frame_id: u64, stages: Stages) -> Costs {
    record(host, frame_id, FrameFlags::MEASURE, stages);
    host.view.report().costs.unwrap()
}

fn sum(costs: &Costs) -> f64 {
    CostItem::ALL.iter().map(|e| costs.ms(*e)).sum()
}

#[test]
fn effects_add_up_to_the_whole_and_what_did_not_run_costs_nothing() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    record(&mut host, 0, FrameFlags(0), Stages::ALL);
    assert_eq!(host.view.report().costs, None, "nobody asked");
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    let first = measured(&mut host, 1, Stages::ALL);
    let ran = |costs: &Costs| CostItem::ALL.into_iter().filter(|e| costs.ms(*e) > 0.0).collect::<Vec<_>>();
    use CostItem::{Background, Medium, SkyTables, SkyView, Tone, Veil};
    assert_eq!(ran(&first), [SkyTables, SkyView, Background, Medium, Tone], "{first:?}");
    let second = measured(&mut host, 2, Stages::ALL);
    assert_eq!(ran(&second), [Background, Medium, Tone], "tables are kept: {second:?}");
    host.view.frame_textures().unwrap();
    let third = measured(&mut host, 3, Stages::BACKGROUND.with(Stages::MEDIUM));
    assert_eq!(ran(&third), [Background, Medium, Veil], "{third:?}");
    record(&mut host, 4, FrameFlags(0), Stages::ALL);
    assert_eq!(host.view.report().costs, None, "and not any more");
    for costs in [first, second, third] {
        let share = sum(&costs) / costs.whole_ms;
        assert!((0.6..1.001).contains(&share), "{share} of {costs:?}");
    }
}

/// The sum agrees with an outside clock around stages that are recorded and waited for one by one, without MEASURE.
#[test]
fn the_sum_of_the_costs_agrees_with_an_outside_clock() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    let (mut ratios, stages) = (Vec::new(), [Stages::BACKGROUND, Stages::MEDIUM, Stages::TONE]);
    record(&mut host, 0, FrameFlags::MEASURE, Stages::ALL);
    host.device.wait().unwrap();
    for id in 1..40 {
        let start = Instant::now();
        for stage in stages {
            record(&mut host, 2 * id, FrameFlags(0), stage);
            host.device.wait().unwrap();
        }
        let outside = start.elapsed().as_secs_f64() * 1e3;
        ratios.push(sum(&measured(&mut host, 2 * id + 1, Stages::ALL)) / outside);
        host.device.wait().unwrap();
    }
    ratios.sort_by(f64::total_cmp);
    let median = ratios[ratios.len() / 2];
    assert!((0.6..1.1).contains(&median), "{median}: {ratios:?}");
}

#[test]
fn a_measured_picture_is_the_same_to_rounding() {
    for (format, space, step) in [
        (wgpu::TextureFormat::Rgba16Float, ColorSpace::SceneLinear, 2e-3),
        (wgpu::TextureFormat::Rgba8Unorm, ColorSpace::SceneLinear, 1e-6),
        (wgpu::TextureFormat::Rgba8Unorm, ColorSpace::DisplaySrgb, 2.1 / 255.0),
    ] {
        let mut host = Host::new(format);
        let mut picture = |flags| {
            host.clear([0.2, 0.3, 0.4, 1.0], 5e-5);
            let mut frame = Frame::new(7, camera(), &host.color, Some(&host.depth));
            (frame.color_space, frame.flags) = (space, flags);
            host.view.record(&host.context, &frame, Stages::ALL).unwrap();
            let costs = host.view.report().costs;
            // The next call may use the same id, which decides the dither, again.
            frame.frame_id = 8;
            host.view.record(&host.context, &frame, Stages::PREPARE).unwrap();
            (host.pixels(), costs)
        };
        let (plain, none) = picture(FrameFlags(0));
        let (measured, costs) = picture(FrameFlags::MEASURE);
        let worst = plain.as_flattened().iter().zip(measured.as_flattened()).map(|(a, b)| (a - b).abs());
        assert!(worst.clone().fold(0.0, f32::max) < step, "{format:?}: {}", worst.fold(0.0, f32::max));
        // With 8 bits a channel, tone mapping is not drawn separately.
        let fused = format == wgpu::TextureFormat::Rgba8Unorm && space == ColorSpace::SceneLinear;
        assert!(none.is_none() && (costs.unwrap().ms(CostItem::Composition) > 0.0) == fused, "{format:?} {costs:?}");
    }
}

#[test]
fn calls_of_one_frame_are_added_and_a_new_frame_begins_anew() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    let prepared = measured(&mut host, 1, Stages::PREPARE);
    let background = measured(&mut host, 1, Stages::BACKGROUND);
    assert_eq!(prepared.ms(CostItem::SkyTables), background.ms(CostItem::SkyTables));
    assert!(background.ms(CostItem::Background) > 0.0 && background.whole_ms > prepared.whole_ms);
    assert_eq!(measured(&mut host, 2, Stages::BACKGROUND).ms(CostItem::SkyTables), 0.0);
}

#[test]
fn a_hosts_own_encoder_is_not_measured() {
    let mut host = Host::new(wgpu::TextureFormat::Rgba16Float);
    let mut encoder = host.device.device.create_command_encoder(&Default::default());
    let mut frame = Frame::new(1, camera(), &host.color, Some(&host.depth));
    frame.flags = FrameFlags::MEASURE;
    let e = host.view.record_into(&host.context, &frame, Stages::ALL, &mut encoder).unwrap_err();
    assert!(e.status == Status::Unsupported && e.to_string().contains("MEASURE"), "{e}");
}

//! Pictures for which the plan draws a deck instead of a volume.

use glam::DVec3;
use welkin::{
    clouds::CloudModel,
    frame::{FrameFlags, PARTS},
    light::luminance,
    plan::{Budget, Part, PartPlan, PartWish, Reason},
};

use crate::drawn::{BROKEN, SIZE, Sky};

/// Frames until a gauge has a result and the fade to the plan's choice has ended.
const SETTLED: u32 = 60;

/// Creates a depth texture that is near everywhere except in this many rows of sky at the picture's top.
fn slit(sky: &Sky, rows: u32) -> wgpu::Texture {
    let depth = welkin_support::textures::texture(&sky.device, SIZE, wgpu::TextureFormat::R32Float, 1);
    let texels: Vec<f32> = (0..SIZE.0 * SIZE.1).map(|i| if i / SIZE.0 < rows { 0.0 } else { 0.1 }).collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE.0), rows_per_image: None };
    sky.device.queue.write_texture(depth.as_image_copy(), bytemuck::cast_slice(&texels), layout, depth.size());
    depth
}

/// Returns the settled plan for the clouds in a picture with this many rows of sky, and that picture.
fn planned(report: &str, rows: u32, tolerance: f64) -> (PartPlan, Vec<[f64; 3]>) {
    let mut sky = Sky::new(report, CloudModel::Volume);
    // All other parts are drawn.
    let wish = |part: &Part| PartWish { rung: (part.name != "clouds").then_some(0), ..PartWish::default() };
    let wishes = PARTS.iter().map(wish).collect();
    sky.view.set_budget(Budget { tolerance: Some(tolerance), wishes, ..Budget::default() }).unwrap();
    let depth = slit(&sky, rows);
    let forward = DVec3::new(0.0, 1.0, 0.35);
    let mut picture = Vec::new();
    for _ in 0..SETTLED {
        picture = sky.look(forward, 2.0, Some(&depth), FrameFlags(0));
    }
    let place = PARTS.iter().position(|part| part.name == "clouds").unwrap();
    (sky.view.plan().parts[place], picture)
}

/// Draws the same picture in a context whose model is the deck.
fn deck(report: &str, rows: u32) -> Vec<[f64; 3]> {
    let mut sky = Sky::new(report, CloudModel::Deck);
    let depth = slit(&sky, rows);
    // As many frames as with the plan, because the sky's tables need some frames to follow the air.
    let take = |_| sky.look(DVec3::new(0.0, 1.0, 0.35), 2.0, Some(&depth), FrameFlags(0));
    (0..SETTLED).map(take).last().unwrap_or_default()
}

#[test]
fn a_sky_seen_through_a_slit_needs_no_volume_and_one_that_fills_the_picture_does() {
    let (clouds, picture) = planned(BROKEN, 2, 0.15);
    assert_eq!((clouds.reason, clouds.rung), (Reason::WithinTolerance, 1), "{clouds:?}");
    let wanted = deck(BROKEN, 2);
    let sky = 2 * SIZE.0 as usize;
    let apart = picture.iter().zip(&wanted).take(sky).map(|(a, b)| (luminance(a) / luminance(b) - 1.0).abs());
    let worst = apart.fold(0.0, f64::max);
    assert!(worst < 1e-3, "what is left is the deck's picture: {worst}");
    let (clouds, _) = planned(BROKEN, SIZE.1, 0.05);
    assert_eq!((clouds.reason, clouds.share), (Reason::Needed, 1.0), "{clouds:?}");
    assert!(clouds.last().p95 > 0.1 && clouds.work > 0.5 * f64::from(SIZE.0 * SIZE.1), "{clouds:?}");
}

/// The driver of a digger sees the sky over the pit's edge in the upper half of the picture. Fair weather is drawn as a
/// volume there, and as a deck if the tolerance is large.
#[test]
fn a_fair_sky_over_half_of_the_picture_is_a_volume_or_by_a_large_tolerance_a_deck() {
    let fair = "LOWI 121150Z 00000KT 9999 FEW040 18/12 Q1015";
    let (clouds, _) = planned(fair, SIZE.1 / 2, 0.02);
    println!("fair weather over half of the picture: {:?}, p95 {:.3}", clouds.reason, clouds.last().p95);
    assert_eq!((clouds.reason, clouds.share), (Reason::Needed, 1.0), "{clouds:?}");
    let (clouds, _) = planned(fair, SIZE.1 / 2, 0.95);
    assert_eq!((clouds.reason, clouds.rung), (Reason::WithinTolerance, 1), "{clouds:?}");
}

#[test]
fn an_overcast_ceiling_is_a_deck_already_and_fog_hides_all_clouds() {
    let (clouds, _) = planned("LOWI 121150Z 00000KT 9999 OVC020 18/12 Q1015", SIZE.1, 0.01);
    assert_eq!(clouds.reason, Reason::Absent, "{clouds:?}");
    let report = "LOWI 121150Z 00000KT 0050 FG SCT030 12/12 Q1015";
    let (clouds, _) = planned(report, SIZE.1, 0.05);
    assert_eq!((clouds.reason, clouds.rung), (Reason::WithinTolerance, 1), "{clouds:?}");
}

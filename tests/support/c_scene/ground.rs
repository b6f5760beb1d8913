//! A terrain set through the C functions, for the tests of every kind of host, and checks of its texture.

use welkin::capi::{
    area::*, device::*, ground::*, ground_grid::*, ground_texture::*, rain::*, status::*, timeline::*, weather::*,
    weather_kinds::*,
};

use super::{Scene, init, message, ok};

pub const CELL_M: f64 = 2.0;
pub const ORIGIN: [f64; 3] = [-6.0, 30.0, 0.5];

/// Creates a view of a context with simulated ground.
pub fn scene(device: *mut wk_device) -> Scene {
    let simulation = wk_simulation_desc { ground_model: WK_GROUND_SIMULATED, ..init("wk_simulation_desc") };
    Scene::with(device, (&raw const simulation).cast())
}

/// Sets a terrain that slopes to the south-east, with a pit of 0.2 m, two nodes wide, at its north-western end.
pub fn set_grid(scene: &Scene, nodes: [u32; 2]) {
    let height = |i: u32| {
        let (x, y) = (i % nodes[0], i / nodes[0]);
        let pit = (1..3).contains(&x) && (nodes[1] - 3..nodes[1] - 1).contains(&y);
        0.02 * (y as f32 - x as f32) - if pit { 0.2 } else { 0.0 }
    };
    let heights: Vec<f32> = (0..nodes[0] * nodes[1]).map(height).collect();
    let grid = wk_ground_grid {
        origin_m: ORIGIN,
        cell_m: CELL_M,
        nodes,
        heights_m: heights.as_ptr(),
        height_count: heights.len() as u32,
        ..init("wk_ground_grid")
    };
    // SAFETY: live pointers.
    ok(unsafe { wk_context_set_ground_grid(scene.context, &grid) });
}

/// Sets rain at this rate between two times, with more of it around the south-western corner, and a roof in the east.
pub fn rain(scene: &Scene, rate_mm_h: f64, from_s: f64, to_s: f64) {
    let weather = wk_weather {
        precipitation_kind: if rate_mm_h > 0.0 { WK_PRECIPITATION_RAIN } else { WK_PRECIPITATION_NONE },
        precipitation_rate_mm_h: rate_mm_h,
        ..init("wk_weather")
    };
    let area = wk_rain_area {
        center_m: [ORIGIN[0] - 6.0, ORIGIN[1] - 6.0, 0.0],
        semi_axes_m: [16.0, 16.0],
        rim_m: 12.0,
        rate_mm_h: 4.0 * rate_mm_h,
        motion: WK_AREA_MOTION_OWN,
        ..init("wk_rain_area")
    };
    let [x, y, z] = ORIGIN;
    let roof =
        wk_shelter { center_m: [x + 12.0, y + 3.0, z + 4.0], half_size_m: [5.5, 3.5, 0.1], ..init("wk_shelter") };
    // SAFETY: live pointers with the sizes given.
    unsafe {
        ok(wk_context_set_weather(scene.context, &weather, from_s, 0.0));
        ok(wk_context_set_shelters(scene.context, &roof, 1, size_of::<wk_shelter>() as u32));
        ok(wk_context_set_rain_areas(scene.context, &area, 1, size_of::<wk_rain_area>() as u32));
        let mut update = || wk_context_update(scene.context, to_s);
        ok(std::iter::repeat_with(&mut update).find(|status| *status != WK_PENDING).unwrap());
    }
}

/// The terrain's current texture.
pub fn texture(scene: &Scene) -> wk_ground_texture {
    let mut texture = init("wk_ground_texture");
    // SAFETY: live pointers.
    ok(unsafe { wk_context_get_ground_texture(scene.context, &mut texture) });
    texture
}

/// Asserts that a missing texture is refused and nothing is written.
pub fn assert_none(scene: &Scene) {
    let mut texture = wk_ground_texture { generation: 77, ..init("wk_ground_texture") };
    // SAFETY: live pointers.
    let status = unsafe { wk_context_get_ground_texture(scene.context, &mut texture) };
    assert!(status == WK_ERROR_WRONG_ORDER && message().contains("wk_context_set_ground_grid"), "{}", message());
    assert_eq!((texture.texture, texture.generation), (0, 77));
}

/// The terrain's cells as they are in the texture, and their revision.
pub fn cells(scene: &Scene, count: usize) -> (Vec<[f32; 4]>, u64) {
    let mut cells = vec![wk_ground_cell { film_mm: 0.0, soaked: 0.0, standing_mm: 0.0, ice: 0.0 }; count];
    let (size, mut revision) = (size_of::<wk_ground_cell>() as u32, 0);
    // SAFETY: live pointers with the sizes given.
    ok(unsafe { wk_context_get_ground_cells(scene.context, cells.as_mut_ptr(), count as u32, size, &mut revision) });
    (cells.iter().map(|c| [c.film_mm, c.soaked, c.standing_mm, c.ice]).collect(), revision)
}

/// Asserts that the texels equal the cells, in order, to a half float's precision. Texels without standing water may be
/// negative.
#[track_caller]
pub fn assert_cells(texels: &[[f32; 4]], cells: &[[f32; 4]]) {
    assert_eq!(texels.len(), cells.len());
    for (i, (texel, cell)) in texels.iter().zip(cells).enumerate() {
        let shown = [texel[0], texel[1], texel[2].max(0.0), texel[3]];
        let close = shown.iter().zip(cell).all(|(t, c)| (t - c).abs() <= c / 2048.0 + 1e-7);
        assert!(close, "texel {i}: {texel:?}, wanted {cell:?}");
    }
}

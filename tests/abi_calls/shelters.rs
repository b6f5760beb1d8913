//! Shelters through the C interface: boxes, and planes that cut them.

use super::world::{World, init, message};
use welkin::capi::{rain::*, status::*};

#[test]
fn planes_that_make_no_shape_are_refused_by_name() {
    let world = World::new();
    let set = |shape: &wk_shelter_shape| {
        let shelters = [init("wk_shelter"), wk_shelter { next: (&raw const *shape).cast(), ..init("wk_shelter") }];
        // SAFETY: live pointers.
        unsafe { wk_context_set_shelters(world.context, shelters.as_ptr(), 2, size_of::<wk_shelter>() as u32) }
    };
    let shape = |planes: &[[f64; 4]]| {
        let mut shape = wk_shelter_shape { plane_count: planes.len() as u32, ..init("wk_shelter_shape") };
        shape.planes[..4 * planes.len()].copy_from_slice(planes.as_flattened());
        shape
    };
    let gable = shape(&[[0.0, 0.6, 0.8, 0.5], [0.0, -0.6, 0.8, 0.5]]);
    for good in [gable, shape(&[]), shape(&[[1.0, 0.0, 0.0, 0.2]; 16])] {
        assert_eq!(set(&good), WK_OK, "{}", message());
    }
    let mut nan = gable;
    nan.planes[7] = f64::NAN;
    for (bad, wanted) in [
        (wk_shelter_shape { plane_count: 17, ..gable }, "wk_shelter_shape.plane_count must be at most 16, got 17"),
        (nan, "wk_shelter_shape.planes[7] must be finite"),
        (
            shape(&[[0.0, 1.0, 1.0, 0.0]]),
            "shelters[1].planes must be unit vectors and distances within 1e6 m in plane 0",
        ),
        (shape(&[[0.0, 0.0, 1.0, -1.5]]), "shelters[1].planes must be planes that leave some of the box"),
        (wk_shelter_shape { reserved0: 1, ..gable }, "wk_shelter_shape.reserved0 must be 0"),
    ] {
        assert_eq!(set(&bad), WK_ERROR_INVALID_ARGUMENT, "{wanted}");
        assert!(message().contains(wanted), "{wanted}: {}", message());
    }
}

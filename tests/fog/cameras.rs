//! One camera for every depth convention a host may have, for the tests to loop over.

use glam::{DMat4, DVec3, DVec4};
use welkin::scene::{Camera, ClipSpace, DepthKind, DepthMapping};

/// A camera, its mapping, and its name in a failure.
pub struct Case {
    pub name: String,
    pub camera: Camera,
    pub mapping: DepthMapping,
}

/// Columns of a perspective frustum (left, right, bottom, top at unit distance) with depth row (a, b):
/// clip z = a z + b.
fn frustum([l, r, b, t]: [f64; 4], za: f64, zb: f64) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(2.0 / (r - l), 0.0, 0.0, 0.0),
        DVec4::new(0.0, 2.0 / (t - b), 0.0, 0.0),
        DVec4::new((r + l) / (r - l), (t + b) / (t - b), za, -1.0),
        DVec4::new(0.0, 0.0, zb, 0.0),
    )
}

/// Depth row of near `n` and far `f` (infinite allowed) for window depth 0 at near, or reversed, in `clip`.
fn depth_row(n: f64, f: f64, reversed: bool, clip: ClipSpace) -> (f64, f64) {
    let (a, b) = if f.is_infinite() { (-1.0, -n) } else { (-f / (f - n), -f * n / (f - n)) };
    // Window depth d = -(a + b/z); reversing is 1 - d, that is w - z.
    let (a, b) = if reversed { (-1.0 - a, -b) } else { (a, b) };
    match clip {
        ClipSpace::ZeroToOne => (a, b),
        ClipSpace::MinusOneToOne => (2.0 * a + 1.0, 2.0 * b),
    }
}

/// A camera looking at `forward` with the projection's numbers rounded to f32, as a C host's are.
pub fn camera(projection: DMat4, forward: DVec3) -> Camera {
    let base = Camera::look_to(DVec3::ZERO, forward, DVec3::Z, 1.0, 1.0, 0.1);
    Camera { projection: projection.as_mat4().as_dmat4(), ..base }
}

/// Lists cameras with every kind of depth and both clip spaces: straight, off-axis and stereo, with the near plane at
/// 0.1 m.
pub fn all() -> Vec<Case> {
    let forward = DVec3::new(0.3, 1.0, 0.1);
    let straight = [-1.2, 1.2, -0.7, 0.7];
    let off_axis = [-0.2, 1.9, -0.1, 1.1];
    let mut out = Vec::new();
    for clip in [ClipSpace::ZeroToOne, ClipSpace::MinusOneToOne] {
        for reversed in [false, true] {
            for (shape, rect) in [("straight", straight), ("off-axis", off_axis)] {
                for far in [1e5, f64::INFINITY] {
                    let (a, b) = depth_row(0.1, far, reversed, clip);
                    out.push(Case {
                        name: format!("perspective far {far} reversed {reversed} {clip:?} {shape}"),
                        camera: camera(frustum(rect, a, b), forward),
                        mapping: DepthMapping { kind: DepthKind::Perspective, reversed, clip },
                    });
                }
            }
            let (a, b) = if reversed { (1.0 / 1.2e5, 1.0 + 2e4 / 1.2e5) } else { (-1.0 / 1.2e5, -2e4 / 1.2e5) };
            let (a, b) = if reversed { (a, b - 2.0 * 2e4 / 1.2e5) } else { (a, -b) };
            let (a, b) = if clip == ClipSpace::MinusOneToOne { (2.0 * a, 2.0 * b - 1.0) } else { (a, b) };
            let parallel = DMat4::from_cols(
                DVec4::new(1.0 / 300.0, 0.0, 0.0, 0.0),
                DVec4::new(0.0, 1.0 / 200.0, 0.0, 0.0),
                DVec4::new(0.0, 0.0, a, 0.0),
                DVec4::new(0.1, 0.2, b, 1.0),
            );
            out.push(Case {
                name: format!("parallel reversed {reversed} {clip:?}"),
                camera: camera(parallel, forward),
                mapping: DepthMapping { kind: DepthKind::Orthographic, reversed, clip },
            });
        }
        let (a, b) = depth_row(0.1, 1e5, false, clip);
        for (c, far_m) in [(1.0, 1e7), (1e-3, 1e6)] {
            out.push(Case {
                name: format!("logarithmic c {c} {clip:?}"),
                camera: camera(frustum(off_axis, a, b), forward),
                mapping: DepthMapping { kind: DepthKind::Logarithmic { c, far_m }, reversed: false, clip },
            });
        }
        // A stereo eye whose shift sits in the projection: projection x translation by half the eye distance.
        let eye = DMat4::from_translation(DVec3::new(0.032, 0.0, 0.0));
        let (a, b) = depth_row(0.1, 1e5, true, clip);
        out.push(Case {
            name: format!("stereo eye {clip:?}"),
            camera: camera(frustum([-1.3, 1.1, -0.7, 0.7], a, b) * eye, forward),
            mapping: DepthMapping { kind: DepthKind::Perspective, reversed: true, clip },
        });
    }
    out
}

/// Window depth and ndc of the camera-relative world point `p`, by the definition: the matrix, then the divide.
pub fn project(case: &Case, p: DVec3) -> (f64, DVec3) {
    let clip = case.camera.projection * (case.camera.rotation() * p).extend(1.0);
    let ndc = clip.truncate() / clip.w;
    let depth = match case.mapping.kind {
        DepthKind::Logarithmic { c, far_m } => (c * clip.w).ln_1p() / (c * far_m).ln_1p(),
        _ if case.mapping.clip == ClipSpace::MinusOneToOne => 0.5 * ndc.z + 0.5,
        _ => ndc.z,
    };
    (depth, ndc)
}

//! Frames and targets
//!
//! A wk_frame describes what the host has drawn: the camera, the meaning of the numbers in its depth and colour, and
//! the images. All matrices are column-major with column vectors (OpenGL, Vulkan, glm): m[4 * column + row].
//!
//! position_m gives the camera's position in double precision; Welkin ignores the translation of `view`. Any projection
//! works: perspective, off-axis, one eye of a stereo pair, orthographic, infinite far plane, reversed depth.
//!
//! Welkin reads depth as the projection gives it: z / w, mapped to the depth buffer's range of 0 to 1. With
//! WK_DEPTH_LOGARITHMIC the host's shaders must have written ln(C w + 1) / ln(C far + 1) instead, with w of clip space,
//! C = logarithmic_c and far = logarithmic_far_m. Pixels at the far depth show the sky.
//!
//! `target` points to the images, in the struct for the kind of device: wk_own_target, wk_opengl_target or
//! wk_vulkan_target.

use std::{ffi::c_void, ptr::null};

use glam::{DMat4, DVec3};

use super::{
    boundary::{
        guard,
        layout::{self, init_struct, struct_size},
        numbers::*,
        objects::{ContextObject, wk_context, wk_surface, wk_texture},
    },
    context::{self, WK_EXPOSURE_OF_CONTEXT, wk_exposure_mode},
};
use crate::{
    error::{Error, Result, Status},
    frame::{ColorSpace, DepthAccess, Diagnostic, Frame, FrameFlags, ImageLayers},
    scene::{Camera, ClipSpace, DepthKind, DepthMapping},
};

include!(concat!(env!("OUT_DIR"), "/init_frame.rs"));

/// Relation of depth to distance.
pub type wk_depth_kind = u32;
/// Depth as the projection matrix gives it: perspective (with a finite or infinite far plane) or orthographic.
pub const WK_DEPTH_PROJECTION: wk_depth_kind = 0;
/// ln(C w + 1) / ln(C far + 1), written by the host's shaders, with w of clip space, C = logarithmic_c and far =
/// logarithmic_far_m.
pub const WK_DEPTH_LOGARITHMIC: wk_depth_kind = 1;

/// Range of clip-space z.
pub type wk_clip_space = u32;
/// 0 to 1: Vulkan, Direct3D, Metal, OpenGL with GL_ZERO_TO_ONE.
pub const WK_CLIP_ZERO_TO_ONE: wk_clip_space = 0;
/// -1 to 1: OpenGL's default.
pub const WK_CLIP_MINUS_ONE_TO_ONE: wk_clip_space = 1;

/// Meaning of the numbers in the host's colour.
pub type wk_color_space = u32;
/// Linear Rec. 709, proportional to luminance (cd_m2_per_unit). WK_STAGE_TONE has an effect only in this space.
pub const WK_COLOR_SCENE_LINEAR: wk_color_space = 0;
/// Already tone-mapped, linear Rec. 709 in [0, 1]. Welkin tone-maps its own light and composites linearly.
pub const WK_COLOR_DISPLAY_LINEAR: wk_color_space = 1;
/// Already tone-mapped, and encoded by the sRGB curve: by the host, or by the hardware in an sRGB format.
pub const WK_COLOR_DISPLAY_SRGB: wk_color_space = 2;

/// Welkin's access to the target's depth. The sea and the terrain (wk_context_set_terrain_drawing) are drawn only into
/// depth that may be written. Without sea and terrain, both values give the same picture.
pub type wk_depth_access = u32;
/// Welkin reads the depth, leaves every bit of it as it is, and draws nothing opaque of its own.
pub const WK_DEPTH_ACCESS_READ: wk_depth_access = 0;
/// Welkin tests and writes the depth where it draws opaque things: the sea, and terrain (stage SURFACE, before the
/// water on surfaces). The stencil stays as it is. The depth must have a depth format, as many samples as the colour,
/// and in Vulkan the usage DEPTH_STENCIL_ATTACHMENT. This access is not possible with WK_OPENGL_MULTISAMPLE_RESOLVE of
/// several samples, nor on an own device, whose depth is WK_FORMAT_R32_FLOAT.
pub const WK_DEPTH_ACCESS_READ_WRITE: wk_depth_access = 1;

/// A false-colour picture that replaces a frame's picture, for developers. It shows one quantity per pixel on a scale
/// from black over blue, green, yellow and red to white. In the descriptions of the quantities, "a step" leads from one
/// of these colours to the next. Each quantity names a stage: the wk_view_record with this stage draws the picture.
/// Other calls of the frame draw nothing, except that a call with the stage SURFACE still draws the sea and the terrain
/// if the depth may be written (wk_depth_access). Masked pixels stay the host's. If the frame contains nothing of the
/// quantity, all is black.
pub type wk_diagnostic = u32;
/// The picture itself, not in false colours.
pub const WK_DIAGNOSTIC_NONE: wk_diagnostic = 0;
/// Distance along the ray, on a logarithmic scale: black for 1 m or less, white for 100 km or more and for the sky.
/// Stage MEDIUM.
pub const WK_DIAGNOSTIC_DISTANCE: wk_diagnostic = 1;
/// Optical depth of air, fog, precipitation and clouds between the eye and the visible surface, in the sky without the
/// clouds: black 0, 1 a step, white 5 or more. The columns of rain areas are left out. Stage MEDIUM.
pub const WK_DIAGNOSTIC_OPTICAL_DEPTH: wk_diagnostic = 2;
/// Share of a surface under a film, standing water or clear ice: black 0, 0.2 a step, white 1. Stage SURFACE.
pub const WK_DIAGNOSTIC_WETNESS: wk_diagnostic = 3;
/// Error due to the air, fog and clear sky that the plan leaves out, |Y' - Y| / (Y + 0.01 white) (see Plan and budget
/// of a view), on a logarithmic scale: black 1e-4 or less, white 10 or more. Drops and stars are not counted. Stage
/// MEDIUM.
pub const WK_DIAGNOSTIC_PLAN_ERROR: wk_diagnostic = 4;
/// Number of times that precipitation was drawn over a pixel: black 0, 4 a step, white 20 or more. Stage PARTICLES.
pub const WK_DIAGNOSTIC_OVERDRAW: wk_diagnostic = 5;
/// Speed of the wind that carries the precipitation, 2 m above the host's surfaces: black a calm, 4 m/s a step, white
/// 20 m/s or more. The ground is divided into squares. Each square has an arrow along the wind, or a dot where the wind
/// is slower than 0.3 m/s. The sky is black. Stage MEDIUM.
pub const WK_DIAGNOSTIC_WIND: wk_diagnostic = 6;

/// Flags of a frame.
pub type wk_frame_flags = u32;
/// The camera jumped: nothing of earlier frames may show. If the sky's tables do not fit the weather yet, this frame
/// builds them, as with WK_FRAME_NO_HISTORY.
pub const WK_FRAME_CUT: wk_frame_flags = 1;
/// Draw a picture that depends on seed, time and view alone, without any history. If the sky's tables are not complete
/// yet, this frame builds them, and takes as long as many ordinary frames. Use it for stills and comparisons, not for
/// every frame of a changing weather.
pub const WK_FRAME_NO_HISTORY: wk_frame_flags = 2;
/// Depth is reversed: 1 is near, 0 is far.
pub const WK_FRAME_DEPTH_REVERSED: wk_frame_flags = 4;
/// The first row of the images lies at clip y = -1. This is always so in OpenGL, where the flag need not be set. In
/// Vulkan it is so with a viewport of positive height, where the flag must be set. Without the flag the first row lies
/// at clip y = +1.
pub const WK_FRAME_FIRST_ROW_AT_MINUS_Y: wk_frame_flags = 8;
/// Measure the cost of each effect: wk_report.ms, wk_view_get_costs. Welkin draws stages one by one and waits for the
/// GPU after each, so the frame is slower and its picture may differ by rounding. Use the flag now and then, not in
/// every frame. On a Vulkan host the call returns WK_ERROR_UNSUPPORTED, because the host lends its images for one
/// submission only.
pub const WK_FRAME_MEASURE: wk_frame_flags = 16;
/// The target's normals are in the axes of the camera (x right, y up, z towards the viewer: gl_NormalMatrix *
/// gl_Normal), not in those of the host's world.
pub const WK_FRAME_NORMALS_IN_EYE_SPACE: wk_frame_flags = 32;

/// One frame of one view.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_frame {
    /// sizeof(wk_frame) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_FRAME.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// The host's frame number: the same in all calls of a frame and on all channels of a simulator. Default 0.
    pub frame_id: u64,
    /// Position of the camera in the host's world, m. Default 0, 0, 0.
    pub position_m: [f64; 3],
    /// Matrix from world to eye, of which only the rotation is used. Default identity.
    pub view: [f64; 16],
    /// Matrix from eye to clip space; it must be invertible. Default identity.
    pub projection: [f64; 16],
    /// Relation of depth to distance. Default WK_DEPTH_PROJECTION.
    pub depth_kind: wk_depth_kind,
    /// Range of clip-space z. Default WK_CLIP_ZERO_TO_ONE.
    pub clip_space: wk_clip_space,
    /// Constant C of logarithmic depth, 1/m. Range [1e-9, 1e6] where depth_kind is WK_DEPTH_LOGARITHMIC. Default 1.
    pub logarithmic_c: f64,
    /// Distance at depth 1 of logarithmic depth, m. Range [1e-3, 1e12] where depth_kind is WK_DEPTH_LOGARITHMIC.
    /// Default 1e7.
    pub logarithmic_far_m: f64,
    /// Flags of the frame. Default 0.
    pub flags: wk_frame_flags,
    /// Colour space of the host's colour. Default WK_COLOR_SCENE_LINEAR.
    pub color_space: wk_color_space,
    /// Luminance of the value 1 in a scene-linear colour image, cd/m^2. Range [1e-9, 1e9], default 1.
    pub cd_m2_per_unit: f64,
    /// Source of the exposure. Default WK_EXPOSURE_OF_CONTEXT.
    pub exposure_mode: wk_exposure_mode,
    /// Must be 0.
    pub reserved0: u32,
    /// Value of the exposure, as wk_exposure_mode says. Default 0.
    pub exposure_value: f64,
    /// The images: a wk_own_target, wk_opengl_target or wk_vulkan_target, by the kind of device. May be NULL if the
    /// call's only stage is WK_STAGE_PREPARE.
    pub target: *const c_void,
    /// Velocity of the camera in the host's world, m/s; its length is at most 2000. Rain streaks lie along the drops'
    /// velocity relative to the camera. Default 0, 0, 0.
    pub velocity_m_s: [f64; 3],
    /// Welkin's access to the target's depth. Default WK_DEPTH_ACCESS_READ.
    pub depth_access: wk_depth_access,
    /// False-colour picture to draw in place of the frame's. Default WK_DIAGNOSTIC_NONE.
    pub diagnostic: wk_diagnostic,
}

impl wk_frame {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_FRAME,
        next: null(),
        frame_id: 0,
        position_m: [0.0, 0.0, 0.0],
        view: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        projection: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        depth_kind: WK_DEPTH_PROJECTION,
        clip_space: WK_CLIP_ZERO_TO_ONE,
        logarithmic_c: 1.0,
        logarithmic_far_m: 1e7,
        flags: 0,
        color_space: WK_COLOR_SCENE_LINEAR,
        cd_m2_per_unit: 1.0,
        exposure_mode: WK_EXPOSURE_OF_CONTEXT,
        reserved0: 0,
        exposure_value: 0.0,
        target: null(),
        velocity_m_s: [0.0; 3],
        depth_access: WK_DEPTH_ACCESS_READ,
        diagnostic: WK_DIAGNOSTIC_NONE,
    };
}

/// The images of a frame on an own device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_own_target {
    /// sizeof(wk_own_target) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_OWN_TARGET.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// The image to draw into, of any wk_format with four channels. Default NULL.
    pub color: *const wk_texture,
    /// Surface to draw into if `color` is NULL: Welkin draws into its acquired image. Default NULL.
    pub surface: *const wk_surface,
    /// Depth of the host's picture, WK_FORMAT_R32_FLOAT, as large as `color`. With NULL (the default) every pixel shows
    /// the sky.
    pub depth: *const wk_texture,
    /// Mask: where its red is 1, the host's pixel stays (cab, HUD); where its red is 0, Welkin draws weather.
    /// WK_FORMAT_R8_UNORM, WK_FORMAT_RGBA8_UNORM, WK_FORMAT_RGBA8_SRGB or WK_FORMAT_BGRA8_UNORM, as large as `color`.
    /// Default NULL.
    pub mask: *const wk_texture,
    /// Surface class of each pixel: the byte of red is a wk_surface_class, or 0 to use the class of the host's terrain
    /// or the context's default. WK_FORMAT_R8_UNORM, WK_FORMAT_RGBA8_UNORM or WK_FORMAT_BGRA8_UNORM, as large as
    /// `color`. Default NULL.
    pub surface_classes: *const wk_texture,
    /// Unit normals, in the host's world or in eye space (WK_FRAME_NORMALS_IN_EYE_SPACE): (n + 1) / 2 in normalised
    /// formats, n in float formats. Where a pixel holds no unit vector (a cleared pixel), Welkin uses the normal of the
    /// host's terrain or depth. As large as `color`. Default NULL.
    pub normals: *const wk_texture,
}

impl wk_own_target {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_OWN_TARGET,
        next: null(),
        color: null(),
        surface: null(),
        depth: null(),
        mask: null(),
        surface_classes: null(),
        normals: null(),
    };
}

/// Light for the host's own shading of a frame, in the units of the frame's color_space. The host shows a surface of
/// colour c with normal n as c * (ambient + direct * max(dot(n, direction), 0)).
///
/// In scene-linear space this is exact for matt surfaces. In display spaces the light includes the tone curve at the
/// frame's exposure, so `ambient` and `direct` cannot be right for every surface. They are right for an 18 % grey card,
/// both in shade and facing the sun. With WK_COLOR_DISPLAY_LINEAR c is linear, and the host (or its sRGB framebuffer)
/// encodes the result. With WK_COLOR_DISPLAY_SRGB c and the light are both encoded numbers, as fixed-function OpenGL
/// multiplies them.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct wk_frame_light {
    /// sizeof(wk_frame_light) of your header.
    pub struct_size: u32,
    /// WK_STRUCT_TYPE_FRAME_LIGHT.
    pub struct_type: wk_struct_type,
    /// No extensions in this version: NULL.
    pub next: *const c_void,
    /// Unit vector in the host's world towards the sun, or towards the moon when the moon is brighter.
    pub direction: [f64; 3],
    /// Direct light from `direction` on a surface that faces it, after air, clouds and fog; 0 when that light is below
    /// the horizon.
    pub direct: [f64; 3],
    /// Light from sky, clouds and fog on level ground, and direct light from the fainter of sun and moon.
    pub ambient: [f64; 3],
    /// Light from the ground on a surface that faces down, for hosts with one ambient light above and one below.
    pub ambient_below: [f64; 3],
    /// Display units per cd/m^2 with which Welkin draws the frame.
    pub exposure: f64,
}

impl wk_frame_light {
    pub(crate) const INIT: Self = Self {
        struct_size: struct_size::<Self>(),
        struct_type: WK_STRUCT_TYPE_FRAME_LIGHT,
        next: null(),
        direction: [0.0; 3],
        direct: [0.0; 3],
        ambient: [0.0; 3],
        ambient_below: [0.0; 3],
        exposure: 0.0,
    };
}

/// Gets the light with which the host should light its own objects in a frame. Call this function before you draw the
/// objects. Of `frame`, the call uses the camera's position, color_space, cd_m2_per_unit and the exposure, and ignores
/// the target.
/// Thread: concurrent.
/// Errors: WK_ERROR_INVALID_ARGUMENT naming the field.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn wk_context_get_frame_light(
    context: *const wk_context,
    frame: *const wk_frame,
    out_light: *mut wk_frame_light,
) -> wk_status {
    guard("wk_context_get_frame_light", |call| {
        let object = call.get::<ContextObject>("context", context)?;
        // SAFETY: the caller's promises about `frame` and `out_light`.
        let (c, place) = unsafe { (layout::read(&"frame", frame)?, layout::out_struct(&"out_light", out_light)?) };
        // SAFETY: as above.
        unsafe { layout::check_chain(&"frame", c.next, &[])? };
        let light = from_c(&c, Images::default(), false)?.light(&object.read()).map_err(in_frame)?;
        place.set(&wk_frame_light {
            direction: light.direction.to_array(),
            direct: light.direct,
            ambient: light.ambient,
            ambient_below: light.ambient_below,
            exposure: light.exposure,
            ..wk_frame_light::INIT
        });
        Ok(Status::Ok)
    })
}

/// Images of a frame for the Rust side.
#[derive(Clone, Copy, Default)]
pub(super) struct Images<'a> {
    pub(super) color: Option<&'a wgpu::Texture>,
    pub(super) depth: Option<&'a wgpu::Texture>,
    pub(super) mask: Option<&'a wgpu::Texture>,
    /// Array layers of the images in their textures.
    pub(super) layers: ImageLayers,
    pub(super) surface_classes: Option<&'a wgpu::Texture>,
    pub(super) normals: Option<&'a wgpu::Texture>,
}

/// Converts a C frame, whose fields have been checked one by one, and its images to the Rust API's frame. `bottom_left`
/// says that the first row of the images always lies at clip y = -1, as in OpenGL.
///
/// # Errors
/// The first field that is out of range, named as in the header.
pub(super) fn from_c<'a>(c: &wk_frame, images: Images<'a>, bottom_left: bool) -> Result<Frame<'a>> {
    let kind = match c.depth_kind {
        WK_DEPTH_LOGARITHMIC => DepthKind::Logarithmic { c: c.logarithmic_c, far_m: c.logarithmic_far_m },
        _ if is_orthographic(&c.projection) => DepthKind::Orthographic,
        _ => DepthKind::Perspective,
    };
    let clip = match c.clip_space {
        WK_CLIP_MINUS_ONE_TO_ONE => ClipSpace::MinusOneToOne,
        _ => ClipSpace::ZeroToOne,
    };
    let depth_mapping = DepthMapping { kind, reversed: c.flags & WK_FRAME_DEPTH_REVERSED != 0, clip };
    depth_mapping.validate().map_err(in_frame)?;
    let camera = Camera {
        position: DVec3::from_array(c.position_m),
        view: DMat4::from_cols_array(&c.view),
        projection: DMat4::from_cols_array(&c.projection),
    };
    camera.validate().map_err(in_frame)?;
    let exposure = context::exposure(c.exposure_mode, c.exposure_value);
    if let Some(exposure) = &exposure {
        exposure.validate().map_err(|e| context::exposure_in("frame", e))?;
    }
    Ok(Frame {
        frame_id: c.frame_id,
        camera,
        depth_mapping,
        depth_access: match c.depth_access {
            WK_DEPTH_ACCESS_READ_WRITE => DepthAccess::ReadWrite,
            _ => DepthAccess::Read,
        },
        color: images.color,
        depth: images.depth,
        mask: images.mask,
        layers: images.layers,
        surface_classes: images.surface_classes,
        normals: images.normals,
        color_space: match c.color_space {
            WK_COLOR_DISPLAY_LINEAR => ColorSpace::DisplayLinear,
            WK_COLOR_DISPLAY_SRGB => ColorSpace::DisplaySrgb,
            _ => ColorSpace::SceneLinear,
        },
        cd_m2_per_unit: c.cd_m2_per_unit,
        exposure,
        origin_bottom_left: bottom_left || c.flags & WK_FRAME_FIRST_ROW_AT_MINUS_Y != 0,
        flags: FrameFlags(
            c.flags & (WK_FRAME_CUT | WK_FRAME_NO_HISTORY | WK_FRAME_MEASURE | WK_FRAME_NORMALS_IN_EYE_SPACE),
        ),
        diagnostic: match c.diagnostic {
            WK_DIAGNOSTIC_DISTANCE => Diagnostic::Distance,
            WK_DIAGNOSTIC_OPTICAL_DEPTH => Diagnostic::OpticalDepth,
            WK_DIAGNOSTIC_WETNESS => Diagnostic::Wetness,
            WK_DIAGNOSTIC_PLAN_ERROR => Diagnostic::PlanError,
            WK_DIAGNOSTIC_OVERDRAW => Diagnostic::Overdraw,
            WK_DIAGNOSTIC_WIND => Diagnostic::Wind,
            _ => Diagnostic::None,
        },
        camera_velocity_m_s: DVec3::from_array(c.velocity_m_s),
    })
}

/// Whether the w of a projection does not depend on the point, so that rays are parallel.
fn is_orthographic(m: &[f64; 16]) -> bool {
    m[3] == 0.0 && m[7] == 0.0 && m[11] == 0.0
}

/// Names of a frame's fields on the Rust side and in the header, in the order in which they are tried.
const NAMES: [(&str, &str); 15] = [
    ("frame.camera.position", "frame.position_m"),
    ("camera.position", "frame.position_m"),
    ("camera", "frame"),
    ("depth_mapping.kind", "frame.depth_kind"),
    ("depth_mapping.reversed", "frame.flags"),
    ("depth_mapping", "frame"),
    ("depth_access", "frame.depth_access"),
    ("flags", "frame.flags"),
    ("cd_m2_per_unit", "frame.cd_m2_per_unit"),
    ("camera_velocity_m_s", "frame.velocity_m_s"),
    ("color", "frame.target.color"),
    ("depth", "frame.target.depth"),
    ("mask", "frame.target.mask"),
    ("surface_classes", "frame.target.surface_classes"),
    ("normals", "frame.target.normals"),
];

/// Renames a frame's error to the header's field name.
pub(super) fn in_frame(e: Error) -> Error {
    NAMES.iter().fold(e, |e, (from, to)| e.renamed(from, to))
}

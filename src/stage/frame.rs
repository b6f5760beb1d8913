//! One frame of a host: its camera, its images and the meaning of the numbers in them.

use glam::DVec3;

use super::diagnostic::Diagnostic;
use crate::{
    error::{Error, Result},
    gpu::Layer,
    light::Exposure,
    scene::{Camera, DepthMapping},
};

/// Meaning of the numbers in the host's colour texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum ColorSpace {
    /// Linear Rec. 709, proportional to luminance; [`Frame::cd_m2_per_unit`] gives the unit. The only space in which
    /// Welkin may tone-map the whole picture.
    #[default]
    SceneLinear,
    /// Tone-mapped by the host, linear Rec. 709 in [0, 1]. Welkin tone-maps its own light and composites linearly.
    DisplayLinear,
    /// Tone-mapped by the host and encoded by the sRGB curve. (In an sRGB texture format the hardware encodes.)
    DisplaySrgb,
}

/// Access that Welkin has to a host's depth.
///
/// The sea ([`crate::sea`]) and the terrain ([`crate::land`]) are drawn only into depth that may be written. Without
/// sea and terrain, the picture is the same with either access.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum DepthAccess {
    /// Read only. Welkin changes no bit of the depth and draws nothing opaque
    /// ([`Report::opaque_left_out`](super::Report::opaque_left_out) counts what it leaves out).
    #[default]
    Read,
    /// Test and write the depth where Welkin draws opaque things: in [`Stages::SURFACE`](super::Stages::SURFACE),
    /// before the water on surfaces. The opaque things hide what the host drew farther away and are hidden by what the
    /// host drew nearer. The stencil is kept. Needs a depth format with RENDER_ATTACHMENT and as many samples as the
    /// colour.
    ReadWrite,
}

/// Flags of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct FrameFlags(pub u32);

impl FrameFlags {
    /// The camera jumped: nothing of earlier frames may show. The sky's tables are completed in this frame, as with
    /// `NO_HISTORY`.
    pub const CUT: Self = Self(1);
    /// Draw the frame as a pure function of (seed, time, view), without any history. If the sky's tables are not
    /// complete, they are completed in this frame.
    pub const NO_HISTORY: Self = Self(2);
    /// Measure the cost of each effect ([`Report::costs`](super::Report::costs)). The stages are drawn one by one, and
    /// Welkin waits for each; such a frame is slower, and its picture may differ by rounding. Only for
    /// [`View::record`](crate::frame::View::record).
    pub const MEASURE: Self = Self(16);

    /// Interprets [`Frame::normals`] in the axes of the camera: x right, y up, z towards the viewer. Without this flag
    /// the normals are in the axes of the host's world.
    pub const NORMALS_IN_EYE_SPACE: Self = Self(32);

    /// Whether any flag of `other` is set.
    pub fn has(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}

/// Array layers that hold the images of a frame, counted from 0. The other layers stay untouched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ImageLayers {
    /// Layer of [`Frame::color`].
    pub color: u32,
    /// Layer of [`Frame::depth`].
    pub depth: u32,
    /// Layer of [`Frame::mask`].
    pub mask: u32,
    /// Layer of [`Frame::surface_classes`].
    pub surface_classes: u32,
    /// Layer of [`Frame::normals`].
    pub normals: u32,
}

/// One frame of a host: its camera, what it drew, and the meaning of the numbers in its images.
#[derive(Clone, Copy)]
pub struct Frame<'a> {
    /// The host's frame number, for jitter and dither. All channels of a simulator must give the same number.
    pub frame_id: u64,
    /// The camera.
    pub camera: Camera,
    /// Meaning of the numbers in `depth`.
    pub depth_mapping: DepthMapping,
    /// Whether Welkin may write `depth`. Default: it only reads it.
    pub depth_access: DepthAccess,
    /// Colour texture to draw into; may be absent for [`Stages::PREPARE`](super::Stages::PREPARE) alone. Needs
    /// RENDER_ATTACHMENT and COPY_SRC.
    pub color: Option<&'a wgpu::Texture>,
    /// The host's depth texture. Without it every pixel shows the sky. Needs TEXTURE_BINDING, and RENDER_ATTACHMENT too
    /// with [`DepthAccess::ReadWrite`]. It has as many samples as `color`. If `color` has one sample and Welkin only
    /// reads the depth, the depth may have any number of samples, and Welkin reads the first.
    pub depth: Option<&'a wgpu::Texture>,
    /// Mask in the red channel: 1 keeps the host's pixel (cab, HUD), 0 draws weather. One sample; needs
    /// TEXTURE_BINDING.
    pub mask: Option<&'a wgpu::Texture>,
    /// Material of the surface that each pixel shows. Red is the number of a
    /// [`SurfaceClass`](crate::ground::SurfaceClass), divided by 255; where red is 0, the host's terrain or the
    /// context's default gives the material. One sample; needs TEXTURE_BINDING.
    pub surface_classes: Option<&'a wgpu::Texture>,
    /// Unit normals of the surfaces, in the host's world or in eye space ([`FrameFlags::NORMALS_IN_EYE_SPACE`]):
    /// (n + 1) / 2 in normalised formats, n in float formats. Where the value is no unit vector (such as all zeros or
    /// all ones), the normal follows from the host's terrain and depth. One sample; needs TEXTURE_BINDING.
    pub normals: Option<&'a wgpu::Texture>,
    /// Layers of array textures that hold the images, as for the eyes of a stereo pair. Default: layer 0 of each.
    pub layers: ImageLayers,
    /// Meaning of the numbers in `color`.
    pub color_space: ColorSpace,
    /// Luminance of the value 1 in a scene-linear `color`, cd/m^2, [1e-9, 1e9], default 1.
    pub cd_m2_per_unit: f64,
    /// Exposure of this frame; `None` uses the context's.
    pub exposure: Option<Exposure>,
    /// Whether row 0 of the images is the bottom of the picture, as OpenGL draws.
    pub origin_bottom_left: bool,
    /// Flags: cut, no history, measure, axes of the normals.
    pub flags: FrameFlags,
    /// False-colour picture for developers in place of the frame's. Default: none.
    pub diagnostic: Diagnostic,
    /// Velocity of the camera in the host's axes, m/s, at most 2000; it tilts the streaks of rain and snow. Default 0.
    pub camera_velocity_m_s: DVec3,
}

impl<'a> Frame<'a> {
    /// Creates the frame of a scene-linear host with reversed infinite depth that draws into `color`.
    pub fn new(frame_id: u64, camera: Camera, color: &'a wgpu::Texture, depth: Option<&'a wgpu::Texture>) -> Self {
        Self {
            frame_id,
            camera,
            depth_mapping: DepthMapping { reversed: true, ..Default::default() },
            depth_access: DepthAccess::Read,
            color: Some(color),
            depth,
            mask: None,
            layers: ImageLayers::default(),
            surface_classes: None,
            normals: None,
            color_space: ColorSpace::SceneLinear,
            cd_m2_per_unit: 1.0,
            exposure: None,
            origin_bottom_left: false,
            flags: FrameFlags(0),
            diagnostic: Diagnostic::None,
            camera_velocity_m_s: DVec3::ZERO,
        }
    }

    pub(crate) fn color_layer(&self) -> Option<Layer<'a>> {
        self.color.map(|texture| Layer { texture, index: self.layers.color })
    }

    pub(crate) fn depth_layer(&self) -> Option<Layer<'a>> {
        self.depth.map(|texture| Layer { texture, index: self.layers.depth })
    }

    pub(crate) fn mask_layer(&self) -> Option<Layer<'a>> {
        self.mask.map(|texture| Layer { texture, index: self.layers.mask })
    }

    pub(crate) fn classes_layer(&self) -> Option<Layer<'a>> {
        self.surface_classes.map(|texture| Layer { texture, index: self.layers.surface_classes })
    }

    pub(crate) fn normals_layer(&self) -> Option<Layer<'a>> {
        self.normals.map(|texture| Layer { texture, index: self.layers.normals })
    }

    /// All images with their names.
    pub(crate) fn image_layers(&self) -> [(&'static str, Option<Layer<'a>>); 5] {
        [
            ("color", self.color_layer()),
            ("depth", self.depth_layer()),
            ("mask", self.mask_layer()),
            ("surface_classes", self.classes_layer()),
            ("normals", self.normals_layer()),
        ]
    }

    /// Whether nothing of earlier frames may show.
    pub(crate) fn is_pure(&self) -> bool {
        self.flags.has(FrameFlags(FrameFlags::NO_HISTORY.0 | FrameFlags::CUT.0))
    }

    pub(crate) fn validate(&self) -> Result<()> {
        for (name, layer) in self.image_layers() {
            if let Some(l) = layer.filter(|l| l.index >= l.texture.depth_or_array_layers()) {
                let accepted = format!("below its texture's {} layers", l.texture.depth_or_array_layers());
                return Err(Error::range(&format!("{name}.layer"), &accepted, l.index));
            }
        }
        // With a smaller unit the sun's own value would be infinite.
        if !(1e-9..=1e9).contains(&self.cd_m2_per_unit) {
            return Err(Error::range("cd_m2_per_unit", "in [1e-9, 1e9] cd/m^2", self.cd_m2_per_unit));
        }
        let speed = self.camera_velocity_m_s.length();
        if speed.is_nan() || speed > 2000.0 {
            return Err(Error::range("camera_velocity_m_s", "a vector of at most 2000 m/s", self.camera_velocity_m_s));
        }
        if let Some(exposure) = &self.exposure {
            exposure.validate()?;
        }
        Ok(())
    }
}

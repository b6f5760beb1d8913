//! Frames of an OpenGL host. Each call enters the host's context or a context that shares objects with it, uses the
//! host's images as textures, and restores the host's state.

use wgpu::hal::{api::Gles, gles::TextureInner};

use super::target::{in_map, target};
use crate::{
    capi::{
        boundary::{
            Host,
            objects::{ContextObject, ViewObject, wk_device},
        },
        device::{self, WK_DEVICE_FORCE_TIER0},
        frame::{self, Images, WK_DEPTH_ACCESS_READ_WRITE, in_frame, wk_frame},
        occluder_map::wk_occluder_map,
        opengl_structs::*,
    },
    error::{Error, Result, Status},
    frame::Stages,
    gpu::gl::{GlHost, GlHostDesc, GlImage, GlMode, GlTargetDesc, Handover, Multisample, adopt},
    rain::OccluderMap,
};

/// Creates a device on an OpenGL host.
///
/// # Safety
/// The header's requirements on `wk_opengl_host_desc`.
pub(in crate::capi) unsafe fn open(c: &wk_opengl_host_desc) -> Result<*mut wk_device> {
    let desc = GlHostDesc {
        get_proc: c.get_proc,
        make_current: c.make_current,
        user: c.user,
        mode: if c.mode == WK_OPENGL_HOST_CONTEXT { GlMode::HostContext } else { GlMode::Shared },
        handover: if c.handover == WK_OPENGL_FLUSH { Handover::Flush } else { Handover::Fence },
        force_tier0: c.flags & WK_DEVICE_FORCE_TIER0 != 0,
    };
    // SAFETY: the caller's promise about callbacks and contexts.
    let opened = unsafe { adopt(&desc) }.map_err(|e| e.map_field(|field| format!("desc.{field}")))?;
    device::issue(opened.device, Host::OpenGl(opened.host))
}

/// Records a frame into the images of an OpenGL host.
///
/// # Safety
/// `c.target` is NULL or a live target struct with live names.
pub(in crate::capi) unsafe fn record(host: &GlHost, object: &ViewObject, c: &wk_frame, stages: Stages) -> Result<()> {
    // SAFETY: the caller's promise.
    let target = unsafe { target::<wk_opengl_target>(c.target)? };
    let desc = description(&target, c.depth_access == WK_DEPTH_ACCESS_READ_WRITE)?;
    // All fields are checked before the host's images are touched.
    let mut frame = frame::from_c(c, Images::default(), true)?;
    object.lock().check_call(&frame, stages).map_err(in_frame)?;
    let gpu = object.cell.gpu();
    let entered = gpu.enter()?;
    let images = desc
        .map(|desc| host.target(&gpu.device, &desc))
        .transpose()
        .map_err(|e| e.renamed("target", "frame.target"))?;
    if let Some(images) = &images {
        frame.color = Some(&images.color);
        frame.depth = images.depth_read.as_ref();
        frame.mask = images.mask.as_ref();
        frame.surface_classes = images.surface_classes.as_ref();
        frame.normals = images.normals.as_ref();
    }
    let mut view = object.lock();
    let before = view.recorded_of(frame.frame_id);
    let recorded = view.record(&object.context.read(), &frame, stages).map_err(in_frame);
    drop(entered);
    recorded?;
    host.check().inspect_err(|_| view.take_back(before))
}

/// Sets the occluder maps of a context from images of an OpenGL host.
pub(in crate::capi) fn set_occluder_maps<'a>(
    host: &GlHost,
    object: &ContextObject,
    maps: impl Iterator<Item = &'a wk_occluder_map> + Clone,
) -> Result<()> {
    let gpu = object.cell.gpu();
    let _entered = gpu.enter()?;
    let mut images = Vec::new();
    for (i, map) in maps.clone().enumerate() {
        let (whole, image_of) = (format!("maps[{i}]"), format!("maps[{i}].opengl"));
        let named = |e: Error| e.renamed("target.depth", &image_of).renamed("target", &whole);
        let none = || Error::invalid(&*image_of, "must be given on an OpenGL host's device");
        let depth = image(&map.opengl).ok_or_else(none)?;
        images.push(host.depth(&gpu.device, depth, (map.width, map.height), map.generation).map_err(named)?);
    }
    let list: Vec<_> = maps.zip(&images).map(|(c, depth)| OccluderMap { depth, taken: c.taken(true) }).collect();
    object.write().set_occluder_maps(&list).map_err(in_map("opengl"))
}

/// Converts the target to the Rust side's description; `write_depth` says whether Welkin may write its depth. `None`
/// without a colour image.
fn description(c: &wk_opengl_target, write_depth: bool) -> Result<Option<GlTargetDesc>> {
    let (color, depth, mask) = (image(&c.color), image(&c.depth), image(&c.mask));
    let (surface_classes, normals) = (image(&c.surface_classes), image(&c.normals));
    let Some(color) = color else {
        if [depth, mask, surface_classes, normals].iter().any(Option::is_some) {
            let rest = "must be given where depth, mask, surface_classes or normals are";
            return Err(Error::invalid("frame.target.color", rest));
        }
        return Ok(None);
    };
    for (name, other) in [("depth", depth), ("mask", mask)] {
        if other == Some(color) && !matches!(color, GlImage::Framebuffer { .. }) {
            let field = format!("frame.target.{name}");
            return Err(Error::range(&field, "another image than frame.target.color", "the same name"));
        }
    }
    Ok(Some(GlTargetDesc {
        color,
        depth,
        mask,
        surface_classes,
        normals,
        width: c.width,
        height: c.height,
        generation: c.generation,
        multisample: match c.multisample {
            WK_OPENGL_MULTISAMPLE_RESOLVE => Multisample::Resolve,
            _ => Multisample::Each,
        },
        write_depth,
    }))
}

/// Converts an image; `None` for `WK_OPENGL_NONE`.
fn image(c: &wk_opengl_image) -> Option<GlImage> {
    match c.kind {
        WK_OPENGL_TEXTURE => Some(GlImage::Texture { name: c.name, target: c.target }),
        WK_OPENGL_RENDERBUFFER => Some(GlImage::Renderbuffer { name: c.name }),
        WK_OPENGL_FRAMEBUFFER => Some(GlImage::Framebuffer { name: c.name }),
        _ => None,
    }
}

/// Returns the OpenGL name of a texture.
pub(super) fn native_texture(texture: &wgpu::Texture) -> Result<u64> {
    // SAFETY: the name is only read.
    let hal = unsafe { texture.as_hal::<Gles>() };
    let lost = || Error::new(Status::DeviceLost, "the device is lost: destroy it and create a new one");
    match hal.ok_or_else(lost)?.inner {
        TextureInner::Texture { raw, .. } => Ok(u64::from(raw.0.get())),
        _ => Err(Error::new(Status::Internal, "a texture of Welkin's that is none in OpenGL")),
    }
}

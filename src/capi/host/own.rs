//! Frames of an own device, drawn into its textures or into the image of a window.

use std::sync::Arc;

use super::target::{in_map, target};
use crate::{
    capi::{
        boundary::{
            Call, DeviceCell,
            handles::HandleObject,
            objects::{ContextObject, SurfaceObject, TextureObject, ViewObject},
        },
        frame::{self, Images, in_frame, wk_frame, wk_own_target},
        occluder_map::wk_occluder_map,
        texture::*,
    },
    error::{Error, Result, Status},
    frame::Stages,
    rain::OccluderMap,
};

/// Records a frame into the textures or the surface of an own device.
///
/// # Safety
/// `c.target` is NULL or a live target struct.
pub(in crate::capi) unsafe fn record(call: &mut Call, object: &ViewObject, c: &wk_frame, stages: Stages) -> Result<()> {
    // SAFETY: the caller's promise.
    let target = unsafe { target::<wk_own_target>(c.target)? };
    if !target.color.is_null() && !target.surface.is_null() {
        return Err(Error::invalid("frame.target.surface", "must be NULL where frame.target.color is given"));
    }
    let here = &object.cell;
    let color = of_device::<TextureObject>(call, here, "frame.target.color", target.color)?;
    let depth = of_device::<TextureObject>(call, here, "frame.target.depth", target.depth)?;
    let mask = of_device::<TextureObject>(call, here, "frame.target.mask", target.mask)?;
    let classes = of_device::<TextureObject>(call, here, "frame.target.surface_classes", target.surface_classes)?;
    let normals = of_device::<TextureObject>(call, here, "frame.target.normals", target.normals)?;
    let surface = of_device::<SurfaceObject>(call, here, "frame.target.surface", target.surface)?;
    let mut frame = frame::from_c(c, Images::default(), false)?;
    object.lock().check_call(&frame, stages).map_err(in_frame)?;
    let formats = &[
        WK_FORMAT_RGBA8_UNORM,
        WK_FORMAT_RGBA8_SRGB,
        WK_FORMAT_BGRA8_UNORM,
        WK_FORMAT_BGRA8_SRGB,
        WK_FORMAT_RGBA16_FLOAT,
        WK_FORMAT_RGBA32_FLOAT,
    ];
    check_format("frame.target.color", &color, formats)?;
    check_format("frame.target.depth", &depth, &[WK_FORMAT_R32_FLOAT])?;
    let formats = &[WK_FORMAT_R8_UNORM, WK_FORMAT_RGBA8_UNORM, WK_FORMAT_RGBA8_SRGB, WK_FORMAT_BGRA8_UNORM];
    check_format("frame.target.mask", &mask, formats)?;
    let window = surface.map(|s| s.lock().acquire()).transpose()?;
    let get = |t: &Option<Arc<TextureObject>>| t.as_ref().map(|t| t.texture.clone());
    let (color, depth, mask) = (window.or_else(|| get(&color)), get(&depth), get(&mask));
    let (classes, normals) = (get(&classes), get(&normals));
    (frame.color, frame.depth, frame.mask) = (color.as_ref(), depth.as_ref(), mask.as_ref());
    (frame.surface_classes, frame.normals) = (classes.as_ref(), normals.as_ref());
    object.lock().record(&object.context.read(), &frame, stages).map_err(in_frame)
}

/// Refuses a texture of an unsuitable format; the message has the header's names.
fn check_format(param: &str, texture: &Option<Arc<TextureObject>>, accepted: &[wk_format]) -> Result<()> {
    let Some(texture) = texture else { return Ok(()) };
    if accepted.contains(&texture.format) {
        return Ok(());
    }
    let names: Vec<_> = accepted.iter().map(|f| name_of(*f)).collect();
    let rest = format!("must have one of the formats {}, got {}", names.join(", "), name_of(texture.format));
    Err(Error::about(Status::Unsupported, param, rest))
}

/// Sets the occluder maps of a context from textures of an own device.
pub(in crate::capi) fn set_occluder_maps<'a>(
    call: &mut Call,
    object: &ContextObject,
    maps: impl Iterator<Item = &'a wk_occluder_map> + Clone,
) -> Result<()> {
    let mut textures = Vec::new();
    for (i, map) in maps.clone().enumerate() {
        let param = format!("maps[{i}].texture");
        let found = of_device::<TextureObject>(call, &object.cell, &param, map.texture)?;
        let none = || Error::invalid(&*param, "must not be NULL on an own device");
        textures.push(found.ok_or_else(none)?);
    }
    let list: Vec<_> =
        maps.zip(&textures).map(|(c, t)| OccluderMap { depth: &t.texture, taken: c.taken(false) }).collect();
    object.write().set_occluder_maps(&list).map_err(in_map("texture"))
}

/// Returns an object of this device, or `None` for NULL.
fn of_device<T: HandleObject>(
    call: &mut Call,
    here: &Arc<DeviceCell>,
    param: &str,
    handle: *const T::C,
) -> Result<Option<Arc<T>>> {
    if handle.is_null() {
        return Ok(None);
    }
    let found = call.get::<T>(param, handle)?;
    call.blame(here);
    if found.device().is_some_and(|d| Arc::ptr_eq(d, here)) {
        return Ok(Some(found));
    }
    let rest = format!("must belong to the view's own device, got a {} of another", T::NAME);
    Err(Error::about(Status::BadHandle, param, rest))
}

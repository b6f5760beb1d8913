//! Objects behind the handles. Each file holds the opaque C type of one kind of handle and the object in Rust, with the
//! lock that orders the object's calls if it needs one.

pub(in crate::capi) mod context;
pub(in crate::capi) mod device;
pub(in crate::capi) mod surface;
pub(in crate::capi) mod texture;
pub(in crate::capi) mod view;

pub(in crate::capi) use context::{ContextObject, wk_context};
pub(in crate::capi) use device::{DeviceObject, wk_device};
pub(in crate::capi) use surface::{SurfaceObject, wk_surface};
pub(in crate::capi) use texture::{TextureObject, wk_texture};
pub(in crate::capi) use view::{ViewObject, wk_view};

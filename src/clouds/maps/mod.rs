//! Maps that frames draw a few rows at a time: the clouds' shadows on a plane, which hosts can read too, and the
//! panorama of clouds in all directions.

pub(crate) mod handed;
pub(crate) mod panorama;
pub(crate) mod shadow_map;
pub(crate) mod shadow_projection;

//! Maps that frames make row by row: the clouds' shadows on a plane, handed to hosts too, and the clouds in all
//! directions.

pub(crate) mod handed;
pub(crate) mod panorama;
pub(crate) mod shadow_map;
pub(crate) mod shadow_projection;
